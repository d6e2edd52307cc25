// Choosing cells, and moving bodies between them.

#include "tide/loose_grid.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
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
  const std::vector<Aabb> sample = sampleOf(boxes);
  std::array<Bulk, 3> bulk;
  for (int axis = 0; axis < 3 && !sample.empty(); ++axis) bulk[axis] = bulkOf(sample, axis);
  chooseSteps(boxes, sample, bulk);
  chooseCells(boxes, bulk);
  putInto(boxes);
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

/// As many as it takes to cover the bulk, but not many more than bodies.
void LooseGrid::chooseCells(std::span<const Aabb> boxes, const std::array<Bulk, 3>& bulk) {
  levels_ = {};
  used_levels_ = 0;
  std::array<std::uint32_t, kLevels> bodies{};
  for (const Aabb& box : boxes) {
    if (isEmpty(box)) continue;
    const Extent extent = extentOf(box);
    const std::uint32_t level = levelOf(extent);
    ++bodies[level];
    reach(extent, level);
  }
  Steps low{};
  Steps high{};
  for (int axis = 0; axis < 3; ++axis) {
    std::array<float, 4> corner = low_;
    low[axis] = stepsOf(corner)[axis];
    corner[axis] = static_cast<float>(bulk[axis].high);
    high[axis] = stepsOf(corner)[axis];
  }
  cell_count_ = 0;
  for (std::uint32_t level = 0; level < kLevels; ++level) {
    Level& at = levels_[level];
    for (int axis = 0; axis < 3; ++axis) {
      at.first[axis] = low[axis] >> shiftOf(level);
      at.counts[axis] = (high[axis] >> shiftOf(level)) - at.first[axis] + 1;
    }
    const auto size = [&] { return 1.0 * at.counts[0] * at.counts[1] * at.counts[2]; };
    while (size() > 2.0 * bodies[level] + 1) {
      int most = 0;
      for (const int axis : {1, 2}) {
        if (at.counts[axis] > at.counts[most]) most = axis;
      }
      at.counts[most] = (at.counts[most] + 1) / 2;
    }
    at.strides[0] = 1;
    for (const int axis : {1, 2}) {
      at.strides[axis] = at.strides[axis - 1] * at.counts[axis - 1];
    }
    at.first_cell = cell_count_;
    cell_count_ += static_cast<std::uint32_t>(size());
  }
}

void LooseGrid::putInto(std::span<const Aabb> boxes) {
  lines_.resize(cell_count_);
  std::ranges::fill(lines_, Line());
  free_lines_.clear();
  bodies_.resize(boxes.size());
  for (std::size_t body = 0; body < boxes.size(); ++body) {
    if (body + kPrefetchAhead < boxes.size()) {
      const std::uint32_t cell = cellOf(boxes[body + kPrefetchAhead]);
      if (cell != kNowhere) prefetch(&lines_[cell]);
    }
    const Aabb& box = boxes[body];
    bodies_[body].move(box, cellOf(box), 0);
    if (isEmpty(box)) continue;
    const Extent extent = extentOf(box);
    insert(bodies_[body].cell(), static_cast<std::uint32_t>(body), boundsOf(extent, extent));
  }
  frame_ = 1;
}

std::uint32_t LooseGrid::levelOf(const Extent& extent) {
  const Steps edges = extent.edges();
  const std::int32_t longest = std::max({edges[0], edges[1], edges[2]});
  std::uint32_t level = 0;
  while (level + 1 < kLevels && longest > 1 << shiftOf(level)) ++level;
  return level;
}

inline LooseGrid::Steps LooseGrid::wrapped(Steps cells, const Level& at) {
  Steps from_first = cells - at.first;
  if (isEveryAxis((from_first >= 0) & (from_first < at.counts))) [[likely]]
    return from_first;
  for (int axis = 0; axis < 3; ++axis) {
    from_first[axis] %= at.counts[axis];
    if (from_first[axis] < 0) from_first[axis] += at.counts[axis];
  }
  return from_first;
}

inline LooseGrid::Steps LooseGrid::stepsOf(const std::array<float, 4>& corner) const {
  // The fourth number of a body's box is a whole one. As a float it is below what is normal, with
  // which processors take long to calculate.
  constexpr WholeCorner kAxes = {-1, -1, -1, 0};
  const auto on_axes = std::bit_cast<Corner>(std::bit_cast<WholeCorner>(corner) & kAxes);
  const Corner steps = (on_axes - cornerOf(low_)) * factor_;
  return truncated(smaller(larger(steps, Corner{} - kLastStep), Corner{} + kLastStep));
}

std::uint32_t LooseGrid::cellOf(const Extent& extent, std::uint32_t level) const {
  const Level& at = levels_[level];
  const Steps cell = wrapped(extent.min >> shiftOf(level), at) * at.strides;
  return at.first_cell + static_cast<std::uint32_t>(cell[0] + cell[1] + cell[2]);
}

/// The bytes of all axes; what is lower or higher than they can tell counts as their limit.
inline LooseGrid::Bounds LooseGrid::boundsOnAxes(Steps low, Steps high) {
  const Steps from_last = kLastInCell - low;
#if defined(__SSE2__)
  // Bounds that lie beyond a narrower number become its limit.
  const __m128i words =
      _mm_packs_epi32(std::bit_cast<__m128i>(high), std::bit_cast<__m128i>(from_last));
  const __m128i bytes =
      _mm_min_epu8(_mm_packus_epi16(words, words), _mm_set1_epi8(static_cast<char>(kLastInCell)));
  return std::bit_cast<std::array<Bounds, 2>>(bytes)[0] & 0x00FF'FFFF'00FF'FFFF;
#else
  Bounds bounds = 0;
  for (int axis = 0; axis < 3; ++axis) {
    bounds |= static_cast<Bounds>(std::clamp(high[axis], 0, kLastInCell)) << 8 * axis;
    bounds |= static_cast<Bounds>(std::clamp(from_last[axis], 0, kLastInCell)) << 8 * (axis + 4);
  }
  return bounds;
#endif
}

/// In the cell of a body, which is part of the extent.
inline LooseGrid::Bounds LooseGrid::boundsOf(const Extent& extent, const Extent& body) const {
  const std::uint32_t level = levelOf(body);
  const Level& at = levels_[level];
  const int to_level = shiftOf(level) - kCellBits;
  const Steps cell = body.min >> shiftOf(level);
  const Steps begin = cell << kCellBits;
  // Who looks into a cell takes it for one in the bulk.
  const Steps from_first = cell - at.first;
  const Steps in_bulk =
      (from_first >= 0) & (from_first < at.counts) & (extent.min >> shiftOf(level) == cell);
  const Steps low = in_bulk & ((extent.min >> to_level) - begin);
  const Steps high = in_bulk ? (extent.max >> to_level) - begin : Steps{} + kLastInCell;
  return kNobody | kSomebody | boundsOnAxes(low, high);
}

void LooseGrid::reach(const Extent& extent, std::uint32_t level) {
  used_levels_ |= 1U << level;
  levels_[level].reach = larger(levels_[level].reach, extent.edges());
}

std::uint32_t LooseGrid::newLine() {
  if (free_lines_.empty()) {
    const auto line = static_cast<std::uint32_t>(lines_.size());
    lines_.resize(lines_.size() + 1);
    return line;
  }
  const std::uint32_t line = free_lines_.back();
  free_lines_.pop_back();
  return line;
}

/// Where a body lies that is in the cell. Nobody could predict the place, so all are looked at.
LooseGrid::Place LooseGrid::find(std::uint32_t cell, std::uint32_t body) {
  for (Line* line = &lines_[cell];; line = &lines_[line->next]) {
    unsigned found = 0;
    for (std::uint32_t place = 0; place < Line::kPlaces; ++place) {
      found |= unsigned{line->bodies[place] == body} << place;
    }
    if (found != 0) return {line, static_cast<std::uint32_t>(std::countr_zero(found))};
  }
}

/// Lines behind a cell's own are full: what comes and goes does so in its own.
void LooseGrid::insert(std::uint32_t cell, std::uint32_t body, Bounds bounds) {
  std::uint32_t place = lines_[cell].count();
  if (place == Line::kPlaces) {
    const std::uint32_t behind = newLine();
    lines_[behind] = std::exchange(lines_[cell], Line());
    lines_[cell].next = behind;
    place = 0;
  }
  lines_[cell].bounds[place] = bounds;
  lines_[cell].bodies[place] = body;
}

void LooseGrid::remove(std::uint32_t cell, std::uint32_t body) {
  const Place hole = find(cell, body);
  Line& own = lines_[cell];
  const std::uint32_t last = own.count() - 1;
  hole.line->bodies[hole.place] = own.bodies[last];
  hole.line->bounds[hole.place] = own.bounds[last];
  own.bounds[last] = kNobody;
  own.bodies[last] = kNowhere;
  if (last == 0 && own.next != kNowhere) {
    free_lines_.push_back(own.next);
    own = lines_[own.next];
  }
}

void LooseGrid::addMoves(std::span<const std::uint32_t> bodies, std::span<const Aabb> boxes) {
  moves_.assign(bodies.begin(), bodies.end());
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (i + kPrefetchFarAhead < bodies.size()) {
      prefetchFar(&boxes[bodies[i + kPrefetchFarAhead]]);
      prefetchFar(&bodies_[bodies[i + kPrefetchFarAhead]]);
    }
    if (i + kPrefetchAhead < bodies.size()) {
      prefetch(&boxes[bodies[i + kPrefetchAhead]]);
      prefetch(&bodies_[bodies[i + kPrefetchAhead]]);
    }
    const std::uint32_t body = bodies[i];
    const Aabb& box = boxes[body];
    std::uint32_t cell = kNowhere;
    if (!isEmpty(box)) {
      const Extent extent = extentOf(box);
      const std::uint32_t level = levelOf(extent);
      cell = cellOf(extent, level);
      reach(extent, level);
    }
    bodies_[body].move(box, cell, frame_);
  }
}

/// Each batch takes one step after the other, in turns with those behind it: so what a step needs
/// comes from memory meanwhile.
void LooseGrid::search(const CollisionFilter& filter, PairBuffer& began, PairBuffer& ended) {
  const std::size_t batches = (moves_.size() + Batch::kMoves - 1) / Batch::kMoves;
  const auto under_way = [&](std::size_t batch) {
    return batch < batches ? &under_way_[batch % kSteps] : nullptr;
  };
  for (std::size_t now = 0; now < batches + kSteps - 1; ++now) {
    if (Batch* const batch = under_way(now)) takeMoves(now * Batch::kMoves, *batch);
    if (Batch* const batch = under_way(now - 1)) prepare(*batch);
    if (Batch* const batch = under_way(now - 2)) {
      if (moves_.size() >= kManyMoves) sendForLinesBehind(*batch);
      makeMoves(*batch);
    }
    // Not in the turn before: to read a line of which a part was just written takes long.
    if (Batch* const batch = under_way(now - 3)) lookIntoCells(*batch);
    if (Batch* const batch = under_way(now - 4)) tellChanges(*batch, filter, began, ended);
  }
}

/// The moves from the given one on.
void LooseGrid::takeMoves(std::size_t first, Batch& batch) {
  const std::span<const std::uint32_t> moves = moves_;
  batch.moves = moves.subspan(first, std::min(Batch::kMoves, moves.size() - first));
  for (const std::uint32_t body : batch.moves) prefetch(&bodies_[body]);
}

/// Finds out what is to be done.
void LooseGrid::prepare(Batch& batch) {
  batch.looks.resize(0);
  for (std::size_t i = 0; i < batch.moves.size(); ++i) {
    batch.bounds[i] = prepareMove(batch.moves[i], batch.looks);
  }
}

/// Adds where to look for whose overlap with a body may change; returns what its bounds become.
LooseGrid::Bounds LooseGrid::prepareMove(std::uint32_t index, LargeArray<Look>& looks) {
  const Body& body = bodies_[index];
  const bool was = body.cellBefore() != kNowhere;
  const bool is = body.cell() != kNowhere;
  if (!was && !is) return kNobody;
  const Extent before = extentOf(body.before);
  const Extent now = extentOf(body.box);
  // Around both places at once, unless it has moved far.
  const Steps far = 1 << kCellBits | now.edges();
  const auto is_near = [&](Steps from, Steps to) {
    return (to - from <= far) & (from - to <= far);
  };
  const bool near = isEveryAxis(is_near(before.min, now.min) & is_near(before.max, now.max));
  const Extent both = {smaller(before.min, now.min), larger(before.max, now.max)};
  // In a cell that it does not leave it is found at both places.
  const Extent& found = body.cell() == body.cellBefore() ? both : now;
  if (near) {
    lookAround(index, both, kBeginnings | kEnds, looks);
  } else {
    if (was) lookAround(index, before, kEnds, looks);
    if (is) lookAround(index, now, kBeginnings, looks);
  }
  return boundsOf(found, now);
}

/// Adds looks into the cells where somebody may overlap the extent.
void LooseGrid::lookAround(std::uint32_t body, const Extent& extent, std::uint32_t wanted,
                           LargeArray<Look>& looks) {
  for (std::uint32_t levels = used_levels_; levels != 0; levels &= levels - 1) {
    const auto level = static_cast<std::uint32_t>(std::countr_zero(levels));
    const Level& at = levels_[level];
    const Surroundings around = surroundings(at, shiftOf(level), extent);
    const std::size_t known = looks.size();
    // One more is written, and not kept.
    looks.resize(known +
                 static_cast<std::size_t>(around.counts[0]) * around.counts[1] * around.counts[2] +
                 1);
    Look* end = looks.data() + known;
    for (std::int32_t z = 0; z < around.counts[2]; z += 2) {
      for (std::int32_t y = 0; y < around.counts[1]; y += 2) {
        for (std::int32_t x = 0; x < around.counts[0]; x += 2) {
          end = lookIntoEight(at, around, Steps{x, y, z, 0}, {0, 0, body, wanted}, end);
        }
      }
    }
    looks.resize(static_cast<std::size_t>(end - looks.data()));
  }
}

inline LooseGrid::Surroundings LooseGrid::surroundings(const Level& at, int shift,
                                                       const Extent& extent) {
  constexpr std::int32_t kFarOff = std::numeric_limits<std::int32_t>::max();
  const Steps first = (extent.min - at.reach) >> shift;
  const Steps last = extent.max >> shift;
  const int to_level = shift - kCellBits;
  const Steps begin = first << kCellBits;
  // Beyond the bulk bounds tell nothing.
  const Steps in_bulk = (first >= at.first) & (last - at.first < at.counts);
  return {.first = wrapped(first, at),
          .counts = smaller(last - first + 1, at.counts),  // all there are, once each
          .low = in_bulk & ((extent.min >> to_level) - begin),
          .high = in_bulk ? (extent.max >> to_level) - begin : Steps{} + kFarOff};
}

/// Adds looks into two cells on each axis, those at the offset and the next, as far as there are
/// any. Without a branch, as nobody could predict how many these are. Returns the end.
inline LooseGrid::Look* LooseGrid::lookIntoEight(const Level& at, const Surroundings& around,
                                                 Steps offset, Look as, Look* looks) const {
  Steps cell = around.first + offset;
  cell -= (cell >= at.counts) & at.counts;
  const Steps next = cell + 1;
  const Steps is_two = around.counts - offset > 1;
  const Steps at_cell = cell * at.strides;
  const std::array<Steps, 2> cells = {
      at_cell, is_two ? (at_cell + at.strides) & (next < at.counts) : at_cell};
  const Steps low = around.low - (offset << kCellBits);
  const Steps high = around.high - (offset << kCellBits);
  const std::array<Bounds, 2> least = {
      boundsOnAxes(high, low), boundsOnAxes(high - (1 << kCellBits), low - (1 << kCellBits))};
  const std::array<Steps, 2> is_there = {Steps{} - 1, is_two};
  for (int z = 0; z < 2; ++z) {
    for (int y = 0; y < 2; ++y) {
      for (int x = 0; x < 2; ++x) {
        as.cell =
            at.first_cell + static_cast<std::uint32_t>(cells[z][2] + cells[y][1] + cells[x][0]);
        as.least = kSomebody | ofAxis(2, least[z]) | ofAxis(1, least[y]) | ofAxis(0, least[x]);
        prefetch(&lines_[as.cell]);
        *looks = as;
        looks += is_there[z][2] & is_there[y][1] & is_there[x][0] & 1;
      }
    }
  }
  return looks;
}

inline unsigned LooseGrid::Line::placesThatReach(Bounds least) const {
#if defined(__SSE2__)
  const __m128i each = _mm_set1_epi64x(static_cast<std::int64_t>(least));
  const auto* const pairs = reinterpret_cast<const __m128i*>(bounds.data());
  const auto highest_bits = [&](int pair) {
    const __m128i rest = _mm_sub_epi8(_mm_load_si128(pairs + pair), each);
    return std::uint64_t{static_cast<std::uint32_t>(_mm_movemask_epi8(rest))} << 16 * pair;
  };
  // Where seven bits are set, adding 1 sets the eighth.
  const std::uint64_t seven =
      (highest_bits(0) | highest_bits(1) | highest_bits(2)) & 0x7F'7F7F'7F7F;
  const std::uint64_t eighth = (seven + 0x01'0101'0101) & 0x80'8080'8080;
  // Each of these five bits next to the one before.
  return static_cast<unsigned>((eighth >> 7) * 0x01'0204'0810 >> 32) & 0x1F;
#else
  unsigned places = 0;
  for (std::uint32_t place = 0; place < kPlaces; ++place) {
    places |= unsigned{reaches(bounds[place], least)} << place;
  }
  return places;
#endif
}

/// Only in crowded cells there are lines that nobody knows of before another one has come.
void LooseGrid::sendForLinesBehind(const Batch& batch) const {
  for (const Look& look : batch.looks) {
    const std::uint32_t next = lines_[look.cell].next;
    prefetch(&lines_[next == kNowhere ? look.cell : next]);
  }
}

/// Puts bodies into their cells.
void LooseGrid::makeMoves(const Batch& batch) {
  for (std::size_t i = 0; i < batch.moves.size(); ++i) {
    const std::uint32_t index = batch.moves[i];
    const Body& body = bodies_[index];
    if (body.cell() == body.cellBefore()) {
      if (body.cell() == kNowhere) continue;
      const Place place = find(body.cell(), index);
      place.line->bounds[place.place] = batch.bounds[i];
      continue;
    }
    ++work_.cell_changes;
    if (body.cellBefore() != kNowhere) left_.push_back({index, body.cellBefore()});
    if (body.cell() != kNowhere) insert(body.cell(), index, batch.bounds[i]);
  }
}

/// Lists who else is there, in these cells, and reaches what was wanted. First the few lines where
/// there is somebody, without a branch: nobody could predict which these are.
void LooseGrid::lookIntoCells(Batch& batch) {
  hits_.resize(batch.looks.size());
  std::size_t hits = 0;
  std::size_t lines_behind = 0;
  for (std::size_t i = 0; i < batch.looks.size(); ++i) {
    const Look& look = batch.looks[i];
    for (const Line* line = &lines_[look.cell];; line = &lines_[line->next]) {
      const unsigned places = line->placesThatReach(look.least);
      hits_[hits] = {line, static_cast<std::uint32_t>(i), places};
      hits += places != 0 ? 1 : 0;
      if (line->next == kNowhere) [[likely]]
        break;
      ++lines_behind;
      hits_.resize(hits_.size() + 1);
    }
  }
  work_.lines += batch.looks.size() + lines_behind;
  addCandidates(batch, hits);
}

/// All but the bodies that are looking.
void LooseGrid::addCandidates(Batch& batch, std::size_t hits) const {
  batch.candidates.resize(hits * Line::kPlaces);
  Candidate* end = batch.candidates.data();
  for (std::size_t i = 0; i < hits; ++i) {
    const Hit& hit = hits_[i];
    const Look& look = batch.looks[hit.look];
    unsigned places = hit.places;
    do {
      const std::uint32_t other =
          hit.line->bodies[static_cast<std::size_t>(std::countr_zero(places))];
      prefetch(&bodies_[other]);
      *end = {other, look.cell, look.body, look.wanted};
      end += other != look.body ? 1 : 0;
      places &= places - 1;
    } while (places != 0);
  }
  batch.candidates.resize(static_cast<std::size_t>(end - batch.candidates.data()));
}

/// Two bodies that both move are a pair of the one that search() comes to last: the higher number.
std::uint32_t LooseGrid::change(const Candidate& candidate) const {
  const Body& body = bodies_[candidate.body];
  const Body& other = bodies_[candidate.other];
  const bool moved = other.frame() == frame_;
  if (moved && candidate.other > candidate.body) return 0;
  const bool was = overlapOnAxes(body.before, moved ? other.before : other.box);
  const bool is = overlapOnAxes(body.box, other.box);
  if (was == is) return 0;
  std::uint32_t wanted = candidate.wanted;
  // A cell that it left tells of ends only, one into which it came of beginnings only.
  if (moved && other.cellBefore() != other.cell()) {
    wanted &= candidate.cell == other.cell() ? kBeginnings : kEnds;
  }
  return wanted & (is ? kBeginnings : kEnds);
}

void LooseGrid::tellChanges(const Batch& batch, const CollisionFilter& filter, PairBuffer& began,
                            PairBuffer& ended) {
  for (const Candidate& candidate : batch.candidates) {
    const std::uint32_t changed = change(candidate);
    if (changed == 0 || !filter.wanted(candidate.body, candidate.other)) continue;
    (changed == kBeginnings ? began : ended).add(candidate.body, candidate.other);
  }
  work_.tests += batch.candidates.size();
}

void LooseGrid::settle() {
  for (std::size_t i = 0; i < left_.size(); ++i) {
    if (i + kPrefetchAhead < left_.size()) prefetch(&lines_[left_[i + kPrefetchAhead].cell]);
    remove(left_[i].cell, left_[i].body);
  }
  left_.clear();
  moves_.clear();
  ++frame_;
}

void LooseGrid::boxes(std::vector<Aabb>& into) const {
  into.resize(bodies_.size());
  for (std::size_t body = 0; body < into.size(); ++body) {
    into[body] = bodies_[body].box;
    into[body].min[3] = into[body].max[3] = 0;
  }
}

/// The cells that bodies are in, by level.
void LooseGrid::draw(DebugDraw& draw) const {
  constexpr Rgb kCellColour = 0x3FA7A0;
  std::map<std::array<std::int32_t, 4>, std::uint32_t> populations;
  for (const Body& body : bodies_) {
    if (isEmpty(body.box)) continue;
    const Extent extent = extentOf(body.box);
    const std::uint32_t level = levelOf(extent);
    Steps cell = extent.min >> shiftOf(level);
    cell[3] = static_cast<std::int32_t>(level);
    ++populations[std::bit_cast<std::array<std::int32_t, 4>>(cell)];
  }
  for (const auto& [cell, population] : populations) {
    Aabb box;
    const double edge = std::ldexp(1.0, shiftOf(static_cast<std::uint32_t>(cell[3]))) / factor_;
    for (int axis = 0; axis < 3; ++axis) {
      box.min[axis] = static_cast<float>(low_[axis] + edge * cell[axis]);
      box.max[axis] = static_cast<float>(low_[axis] + edge * (cell[axis] + 1));
    }
    draw.cell(box, kCellColour, cell[3], population);
  }
}

std::string LooseGrid::validate() const {
  std::size_t present = 0;
  for (std::uint32_t body = 0; body < bodies_.size(); ++body) {
    const Body& of = bodies_[body];
    if (isEmpty(of.box)) continue;
    ++present;
    const Extent extent = extentOf(of.box);
    if (!isEveryAxis(extent.edges() <= levels_[levelOf(extent)].reach)) {
      return fmt::format("body {} reaches farther than its level", body);
    }
    const Bounds bounds = boundsOf(extent, extent) & ~kNobody;
    bool is_there = false;
    for (std::uint32_t line = of.cell(); line != kNowhere; line = lines_[line].next) {
      for (std::uint32_t place = 0; place < lines_[line].count(); ++place) {
        is_there |=
            lines_[line].bodies[place] == body && reaches(lines_[line].bounds[place], bounds);
      }
    }
    if (!is_there) return fmt::format("body {} is not in its cell", body);
  }
  std::size_t in_cells = 0;
  std::size_t lines = free_lines_.size();
  for (std::uint32_t cell = 0; cell < cell_count_; ++cell) {
    if (lines_[cell].count() == 0 && lines_[cell].next != kNowhere)
      return "an empty line before a full one";
    for (std::uint32_t line = cell; line != kNowhere; line = lines_[line].next) {
      if (line != cell && lines_[line].count() < Line::kPlaces)
        return "a line behind a cell's own is not full";
      in_cells += lines_[line].count();
      ++lines;
    }
  }
  if (in_cells != present) return "a cell holds somebody else";
  return lines == lines_.size() ? std::string() : "lines are lost";
}

}  // namespace broadmark::tide
