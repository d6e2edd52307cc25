// Choosing cells, and moving bodies between them.
//
// What an update costs is waiting for memory: for an entry, for the cells around. So what will be
// needed for the moves ahead is sent for beforehand.

#include "tide/loose_grid.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace broadmark::tide {
namespace {

/// What it costs to look into a cell, in tests of a box.
constexpr double kCellCost = 2;
/// From one size of cells that is tried out to the next.
constexpr double kShorter = 0.7;

/// Mean and nearly largest edge of the boxes on an axis.
struct Edges {
  double mean = 0;
  double most = 0;
};

Edges edgesOf(std::span<const Aabb> sample, int axis) {
  std::vector<double> edges;
  double sum = 0;
  for (const Aabb& box : sample) {
    edges.push_back(static_cast<double>(box.max[axis]) - static_cast<double>(box.min[axis]));
    sum += edges.back();
  }
  const auto most = edges.begin() + static_cast<std::ptrdiff_t>(edges.size() * 9 / 10);
  std::ranges::nth_element(edges, most);
  return {sum / static_cast<double>(edges.size()), *most};
}

std::vector<Aabb> sampleOf(std::span<const Aabb> boxes) {
  std::vector<Aabb> sample;
  takeSample(
      boxes.size(), [&](std::size_t i) { return boxes[i]; }, sample);
  std::erase_if(sample, isEmpty);
  return sample;
}

/// How many others a box shares its cell with, on average. Cells far apart may count as one.
double crowding(std::span<const Aabb> boxes, double edge) {
  const std::size_t size = std::bit_ceil(2 * boxes.size());
  std::vector<std::uint32_t> counts(size, 0);
  const double scale = 1 / edge;
  double others = 0;
  for (const Aabb& box : boxes) {
    if (isEmpty(box)) continue;
    std::uint64_t mixed = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double cell = std::clamp(std::floor(box.min[axis] * scale), -1e15, 1e15);
      mixed = (mixed + static_cast<std::uint64_t>(static_cast<std::int64_t>(cell))) *
              0x9E37'79B9'7F4A'7C15;
      mixed ^= mixed >> 32;
    }
    others += 2 * counts[mixed & (size - 1)]++;
  }
  return others / static_cast<double>(boxes.size());
}

}  // namespace

void LooseGrid::build(std::span<const Aabb> boxes) {
  moves_.clear();
  first_number_ = 1;
  const std::vector<Aabb> sample = sampleOf(boxes);
  std::array<Bulk, 3> bulk;
  for (int axis = 0; axis < 3 && !sample.empty(); ++axis) bulk[axis] = bulkOf(sample, axis);
  chooseSteps(boxes, sample, bulk);
  layOut(boxes, bulk);
}

/// The size of the cells that promises to cost least. It begins with large ones, a few bodies in
/// each were they spread evenly: where they are not, smaller ones are better.
void LooseGrid::chooseSteps(std::span<const Aabb> boxes, std::span<const Aabb> sample,
                            const std::array<Bulk, 3>& bulk) {
  constexpr double kBodiesInLargest = 4;
  constexpr double kShortest = 1e-30;
  constexpr double kLongest = 1e30;
  double edge = 1;
  low_ = {};
  if (!sample.empty()) {
    std::array<Edges, 3> edges;
    double longest = 0;
    for (int axis = 0; axis < 3; ++axis) {
      low_[axis] = static_cast<float>(bulk[axis].low);
      longest = std::max(longest, bulk[axis].extent());
      edges[axis] = edgesOf(sample, axis);
    }
    const auto cells = [&](double of_edge) {
      double product = 1;
      for (const Bulk& on_axis : bulk) product *= std::max(1.0, on_axis.extent() / of_edge);
      return product;
    };
    const double wanted = static_cast<double>(boxes.size()) / kBodiesInLargest;
    edge = std::clamp(longest, kShortest, kLongest);
    while (cells(edge) < wanted && edge > kShortest) edge *= kShorter;

    const auto cost = [&](double of_edge) {
      double looked_into = 1;
      for (const Edges& on_axis : edges) {
        looked_into *= 1 + (on_axis.mean + std::min(on_axis.most, of_edge)) / of_edge;
      }
      return looked_into * (kCellCost + crowding(boxes, of_edge));
    };
    for (double least = cost(edge);;) {
      const double shorter = cost(edge * kShorter);
      if (shorter >= least || edge * kShorter < kShortest) break;
      least = shorter;
      edge *= kShorter;
    }
  }
  factor_ = static_cast<float>((1 << kCellBits) / edge);
}

void LooseGrid::layOut(std::span<const Aabb> boxes, const std::array<Bulk, 3>& bulk) {
  levels_ = {};
  used_ = 0;
  for (std::vector<std::uint32_t>& blocks : free_blocks_) blocks.clear();
  entry_of_.assign(boxes.size(), kNowhere);
  const auto for_each_body = [&](auto visit) {
    for (std::size_t body = 0; body < boxes.size(); ++body) {
      if (isEmpty(boxes[body])) continue;
      const Steps min = stepsOf(boxes[body].min);
      const Steps max = stepsOf(boxes[body].max);
      visit(static_cast<std::uint32_t>(body), min, max, levelOf(min, max));
    }
  };
  for_each_body([&](std::uint32_t, const Steps& min, const Steps& max, std::uint32_t level) {
    ++levels_[level].entries;
    reach(min, max, level);
  });

  // As many cells as it takes to cover the bulk, but not many more than bodies.
  Steps low{};
  Steps high{};
  for (int axis = 0; axis < 3; ++axis) {
    std::array<float, 4> corner = low_;
    low[axis] = stepsOf(corner)[axis];
    corner[axis] = static_cast<float>(bulk[axis].high);
    high[axis] = stepsOf(corner)[axis];
  }
  std::uint32_t cells = 0;
  for (std::uint32_t level = 0; level < kLevels; ++level) {
    Level& at = levels_[level];
    for (int axis = 0; axis < 3; ++axis) {
      at.first[axis] = low[axis] >> shiftOf(level);
      at.counts[axis] = (high[axis] >> shiftOf(level)) - at.first[axis] + 1;
    }
    const auto size = [&] {
      double product = 1;
      for (const std::int32_t count : at.counts) product *= count;
      return product;
    };
    while (size() > 2.0 * at.entries + 1) {
      std::int32_t& most = *std::ranges::max_element(at.counts);
      most = (most + 1) / 2;
    }
    at.first_cell = cells;
    cells += static_cast<std::uint32_t>(size());
  }
  cells_.assign(cells, {});
  block_bits_.assign(cells, 0);

  for_each_body([&](std::uint32_t, const Steps& min, const Steps&, std::uint32_t level) {
    ++cells_[placeOf(min, level).cell].count;
  });
  std::size_t places = 0;
  for (const Cell& cell : cells_) places += cell.count == 0 ? 0 : std::bit_ceil(cell.count + 1U);
  entries_.resize(places + places / 4);
  for (std::uint32_t cell = 0; cell < cells; ++cell) {
    const std::uint32_t count = std::exchange(cells_[cell].count, 0);
    if (count > 0) resizeBlock(cell, static_cast<unsigned>(std::bit_width(count)));
  }
  for_each_body([&](std::uint32_t body, const Steps& min, const Steps&, std::uint32_t level) {
    Cell& cell = cells_[placeOf(min, level).cell];
    entry_of_[body] = cell.begin + cell.count;
    entries_[entry_of_[body]].set(boxes[body], body, 0);
    ++cell.count;
  });
}

std::uint32_t LooseGrid::levelOf(const Steps& min, const Steps& max) {
  std::int32_t longest = 0;
  for (int axis = 0; axis < 3; ++axis) longest = std::max(longest, max[axis] - min[axis]);
  std::uint32_t level = 0;
  while (level + 1 < kLevels && longest > 1 << shiftOf(level)) ++level;
  return level;
}

Place LooseGrid::placeOf(const Steps& min, std::uint32_t level) const {
  const Level& at = levels_[level];
  std::uint32_t cell = 0;
  for (int axis = 2; axis >= 0; --axis) {
    cell = cell * static_cast<std::uint32_t>(at.counts[axis]) +
           wrapped(min[axis] >> shiftOf(level), at.first[axis], at.counts[axis]);
  }
  return {level, at.first_cell + cell};
}

Place LooseGrid::placeOf(const Aabb& box) const {
  const Steps min = stepsOf(box.min);
  return placeOf(min, levelOf(min, stepsOf(box.max)));
}

void LooseGrid::reach(const Steps& min, const Steps& max, std::uint32_t level) {
  Counts& reach = levels_[level].reach;
  for (int axis = 0; axis < 3; ++axis) reach[axis] = std::max(reach[axis], max[axis] - min[axis]);
}

std::uint32_t LooseGrid::newBlock(unsigned bits) {
  std::vector<std::uint32_t>& free = free_blocks_[bits];
  if (!free.empty()) {
    const std::uint32_t begin = free.back();
    free.pop_back();
    return begin;
  }
  const std::uint32_t begin = used_;
  used_ += 1U << bits;
  if (used_ > entries_.size()) entries_.resize(used_ + used_ / 4);
  return begin;
}

/// Moves the cell's entries to a block of another size; 0 bits: there is none.
void LooseGrid::resizeBlock(std::uint32_t cell, unsigned bits) {
  Cell& resized = cells_[cell];
  const unsigned bits_before = std::exchange(block_bits_[cell], static_cast<std::uint8_t>(bits));
  const std::uint32_t before = resized.begin;
  if (bits > 0) {
    resized.begin = newBlock(bits);
    for (std::uint32_t i = 0; i < resized.count; ++i) relocate(before + i, resized.begin + i);
  }
  if (bits_before > 0) free_blocks_[bits_before].push_back(before);
}

std::uint32_t LooseGrid::insert(Place place, const Aabb& box, std::uint32_t body,
                                std::uint32_t move) {
  Cell& cell = cells_[place.cell];
  const unsigned bits = block_bits_[place.cell];
  if (bits == 0 || cell.count == 1U << bits) resizeBlock(place.cell, bits + 1);
  const std::uint32_t entry = cell.begin + cell.count;
  entries_[entry].set(box, body, move);
  ++cell.count;
  ++levels_[place.level].entries;
  return entry;
}

void LooseGrid::remove(Place place, std::uint32_t entry) {
  Cell& cell = cells_[place.cell];
  --cell.count;
  --levels_[place.level].entries;
  const std::uint32_t last = cell.begin + cell.count;
  if (entry != last) relocate(last, entry);
  // Smaller with room to spare: it may grow again at once.
  const unsigned bits = block_bits_[place.cell];
  if (cell.count == 0) {
    resizeBlock(place.cell, 0);
  } else if (bits > 1 && cell.count <= 1U << bits >> 2) {
    resizeBlock(place.cell, bits - 1);
  }
}

/// Copies an entry, and tells whoever knew where it was.
void LooseGrid::relocate(std::uint32_t from, std::uint32_t to) {
  const Entry& entry = entries_[to] = entries_[from];
  if ((entry.move() & kLeft) != 0) {
    moves_[(entry.move() >> kFlagBits) - first_number_].left = to;
  } else {
    entry_of_[entry.body()] = to;
  }
}

/// In the order of the cells: neighbours find in the caches what they look at.
void LooseGrid::addMoves(std::span<const std::uint32_t> bodies, std::span<const Aabb> boxes,
                         ThreadTeam& team) {
  constexpr std::size_t kFew = 256;  // these find everything in the caches anyway
  const auto add = [&](std::uint32_t body) {
    Move& move = moves_.emplace_back();
    move.now = boxes[body];
    move.body = body;
    if (isEmpty(move.now)) return;
    const Steps min = stepsOf(move.now.min);
    const Steps max = stepsOf(move.now.max);
    const std::uint32_t level = levelOf(min, max);
    move.place = placeOf(min, level);
    reach(min, max, level);
  };
  if (bodies.size() < kFew) {
    for (const std::uint32_t body : bodies) add(body);
    return;
  }
  sorter_.resize(bodies.size(), team.size());
  const std::span<SortEntry> order = sorter_.entries();
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (i + kPrefetchAhead < order.size()) prefetch(&boxes[bodies[i + kPrefetchAhead]]);
    const Aabb& box = boxes[bodies[i]];
    order[i] = {isEmpty(box) ? 0 : placeOf(box).cell, bodies[i]};
  }
  sorter_.sort(team);
  const std::span<const SortEntry> sorted = sorter_.entries();
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    if (i + kPrefetchAhead < sorted.size()) prefetch(&boxes[sorted[i + kPrefetchAhead].body]);
    add(sorted[i].body);
  }
}

void LooseGrid::update() {
  const std::size_t count = moves_.size();
  for (std::size_t move = 0; move < count; ++move) {
    if (move + 2 * kPrefetchAhead < count)
      prefetch(&entry_of_[moves_[move + 2 * kPrefetchAhead].body]);
    if (move + kPrefetchAhead < count) {
      const std::uint32_t entry = entry_of_[moves_[move + kPrefetchAhead].body];
      if (entry != kNowhere) prefetch(&entries_[entry]);
    }
    updateOne(static_cast<std::uint32_t>(move));
  }
}

void LooseGrid::updateOne(std::uint32_t index) {
  Move& move = moves_[index];
  const std::uint32_t number = (first_number_ + index) << kFlagBits;
  const std::uint32_t entry = std::exchange(entry_of_[move.body], kNowhere);
  const bool comes = entry == kNowhere;
  const bool goes = isEmpty(move.now);
  if (comes) {
    move.before = kEmptyBox;
  } else {
    move.before = entries_[entry].box;
    move.before.min[3] = move.before.max[3] = 0;
    move.place_before = placeOf(move.before);
  }
  if (!comes && !goes && move.place == move.place_before) {
    entries_[entry].set(move.now, move.body, number);
    entry_of_[move.body] = entry;
    return;
  }
  ++work_.cell_changes;
  if (!comes) {
    entries_[entry].setMove(number | kLeft);
    move.left = entry;
  }
  if (!goes) {
    const std::uint32_t now = insert(move.place, move.now, move.body, number | kCame);
    entry_of_[move.body] = now;
  }
}

/// Adds the cells in which there may be somebody whose overlap with the body changes.
void LooseGrid::lookAround(std::uint32_t index) {
  const Move& move = moves_[index];
  const bool was = !isEmpty(move.before);
  const bool is = !isEmpty(move.now);
  if (!was && !is) return;
  const Steps min_before = stepsOf(move.before.min);
  const Steps max_before = stepsOf(move.before.max);
  const Steps min_now = stepsOf(move.now.min);
  const Steps max_now = stepsOf(move.now.max);
  // Around both places at once, unless it has moved far.
  bool near = true;
  for (int axis = 0; axis < 3; ++axis) {
    const std::int32_t both = 1 << kCellBits | (max_now[axis] - min_now[axis]);
    near = near && std::abs(min_now[axis] - min_before[axis]) <= both &&
           std::abs(max_now[axis] - max_before[axis]) <= both;
  }
  if (near) {
    Steps min;
    Steps max;
    for (int axis = 0; axis < 3; ++axis) {
      min[axis] = std::min(min_before[axis], min_now[axis]);
      max[axis] = std::max(max_before[axis], max_now[axis]);
    }
    addCells(index, min, max, kBeginnings | kEnds);
    return;
  }
  if (was) addCells(index, min_before, max_before, kEnds);
  if (is) addCells(index, min_now, max_now, kBeginnings);
}

void LooseGrid::addCells(std::uint32_t move, const Steps& min, const Steps& max, unsigned wanted) {
  for (std::uint32_t level = 0; level < kLevels; ++level) {
    const Level& at = levels_[level];
    if (at.entries == 0) continue;
    Cells cells = {{}, {}, level, move, wanted, 0};
    for (int axis = 0; axis < 3; ++axis) {
      const std::int32_t first = (min[axis] - at.reach[axis]) >> shiftOf(level);
      const std::int32_t last = max[axis] >> shiftOf(level);
      // Where that is all there are, each once.
      cells.counts[axis] = std::min(last - first + 1, at.counts[axis]);
      cells.first[axis] =
          static_cast<std::int32_t>(wrapped(first, at.first[axis], at.counts[axis]));
    }
    forEachRow(at, cells, [&](std::size_t row) {
      prefetch(&cells_[row + static_cast<std::size_t>(cells.first[0])]);
    });
    around_.push_back(cells);
  }
}

/// Lists the entries in the cells, and sends for them.
void LooseGrid::lookInto(Cells& cells) {
  const Level& level = levels_[cells.level];
  forEachRow(level, cells, [&](std::size_t row) {
    std::int32_t x = cells.first[0];
    for (std::int32_t i = 0; i < cells.counts[0]; ++i) {
      const Cell& cell = cells_[row + static_cast<std::size_t>(x)];
      x = x + 1 == level.counts[0] ? 0 : x + 1;
      const Entry* const entries = entries_.data() + cell.begin;
      std::uint32_t rest = cell.count;
      for (; rest > kMostHits; rest -= kMostHits) {
        runs_.push_back({entries + cell.count - rest, kMostHits});
      }
      runs_.push_back({entries + cell.count - rest, rest});
      // Two cache lines; who has more waits for the others, or the processor guesses.
      prefetch(entries);
      prefetch(entries + 2);
    }
  });
  cells.runs_end = runs_.size();
  work_.cells += static_cast<std::uint64_t>(cells.counts[0]) * cells.counts[1] * cells.counts[2];
}

void LooseGrid::settle() {
  for (const Move& move : moves_) {
    if (move.left != kNowhere) remove(move.place_before, move.left);
  }
  first_number_ += static_cast<std::uint32_t>(moves_.size());
  moves_.clear();
  if (first_number_ <= most_numbers_) return;
  first_number_ = 1;
  for (const std::uint32_t entry : entry_of_) {
    if (entry != kNowhere) entries_[entry].setMove(0);
  }
}

void LooseGrid::boxes(std::vector<Aabb>& into) const {
  into.assign(entry_of_.size(), kEmptyBox);
  for (std::size_t body = 0; body < into.size(); ++body) {
    if (entry_of_[body] == kNowhere) continue;
    into[body] = entries_[entry_of_[body]].box;
    into[body].min[3] = into[body].max[3] = 0;
  }
}

/// The cells that bodies are in, by level.
void LooseGrid::draw(DebugDraw& draw) const {
  constexpr Rgb kCellColour = 0x3FA7A0;
  std::vector<std::array<std::int32_t, 4>> drawn;
  for (const std::uint32_t entry : entry_of_) {
    if (entry == kNowhere) continue;
    Steps cell = stepsOf(entries_[entry].box.min);
    const std::uint32_t level = levelOf(cell, stepsOf(entries_[entry].box.max));
    for (int axis = 0; axis < 3; ++axis) cell[axis] >>= shiftOf(level);
    cell[3] = static_cast<std::int32_t>(level);
    drawn.push_back(cell);
  }
  std::ranges::sort(drawn);
  const auto [first, last] = std::ranges::unique(drawn);
  drawn.erase(first, last);
  for (const auto& cell : drawn) {
    Aabb box;
    const double edge = std::ldexp(1.0, shiftOf(static_cast<std::uint32_t>(cell[3]))) / factor_;
    for (int axis = 0; axis < 3; ++axis) {
      box.min[axis] = static_cast<float>(low_[axis] + edge * cell[axis]);
      box.max[axis] = static_cast<float>(low_[axis] + edge * (cell[axis] + 1));
    }
    draw.box(box, kCellColour, cell[3]);
  }
}

std::string LooseGrid::validate() const {
  std::size_t present = 0;
  for (std::size_t body = 0; body < entry_of_.size(); ++body) {
    const std::uint32_t at = entry_of_[body];
    if (at == kNowhere) continue;
    ++present;
    if (at >= used_ || entries_[at].body() != body) return fmt::format("body {} is lost", body);
    const Entry& entry = entries_[at];
    if (entry.move() >= moving()) return fmt::format("body {} still moves", body);
    const Place place = placeOf(entry.box);
    const Cell& cell = cells_[place.cell];
    if (at < cell.begin || at - cell.begin >= cell.count) {
      return fmt::format("body {} is not in its cell", body);
    }
    const Steps min = stepsOf(entry.box.min);
    const Steps max = stepsOf(entry.box.max);
    for (int axis = 0; axis < 3; ++axis) {
      if (max[axis] - min[axis] > levels_[place.level].reach[axis]) {
        return fmt::format("body {} reaches farther than its level", body);
      }
    }
  }
  std::size_t entries = 0;
  std::size_t places = 0;
  for (std::size_t cell = 0; cell < cells_.size(); ++cell) {
    const std::size_t size = block_bits_[cell] == 0 ? 0 : std::size_t{1} << block_bits_[cell];
    if (cells_[cell].count > size) return "a cell has more bodies than places";
    entries += cells_[cell].count;
    places += size;
  }
  if (entries != present) return "a cell holds somebody else";
  std::size_t by_level = 0;
  for (const Level& level : levels_) by_level += level.entries;
  if (by_level != present) return "bodies of a level miscounted";
  for (std::size_t bits = 0; bits < free_blocks_.size(); ++bits) {
    places += free_blocks_[bits].size() << bits;
  }
  return places == used_ ? std::string() : "places are lost";
}

}  // namespace broadmark::tide
