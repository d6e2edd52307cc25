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
    ++bodies[levelOf(extent)];
    reach(extent);
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
      at.strides[axis] = at.strides[axis - 1] * static_cast<std::uint32_t>(at.counts[axis - 1]);
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
  to_move_.assign(boxes.size() / 64 + 1, 0);
}

std::uint32_t LooseGrid::levelOf(const Extent& extent) {
  const Steps edges = extent.edges();
  const std::int32_t longest = std::max({edges[0], edges[1], edges[2]});
  std::uint32_t level = 0;
  while (level + 1 < kLevels && longest > 1 << shiftOf(level)) ++level;
  return level;
}

inline std::uint32_t LooseGrid::wrapped(std::int32_t cell, std::int32_t first, std::int32_t count) {
  const std::uint32_t from_first =
      static_cast<std::uint32_t>(cell) - static_cast<std::uint32_t>(first);
  if (from_first < static_cast<std::uint32_t>(count)) [[likely]]
    return from_first;
  const std::int64_t rest = (std::int64_t{cell} - first) % count;
  return static_cast<std::uint32_t>(rest < 0 ? rest + count : rest);
}

inline LooseGrid::Steps LooseGrid::stepsOf(const std::array<float, 4>& corner) const {
  const Corner steps = (cornerOf(corner) - cornerOf(low_)) * factor_;
  return truncated(smaller(larger(steps, Corner{} - kLastStep), Corner{} + kLastStep));
}

std::uint32_t LooseGrid::cellOf(const Extent& extent) const {
  const std::uint32_t level = levelOf(extent);
  const Level& at = levels_[level];
  const Steps cells = extent.min >> shiftOf(level);
  std::uint32_t cell = at.first_cell;
  for (int axis = 0; axis < 3; ++axis) {
    cell += wrapped(cells[axis], at.first[axis], at.counts[axis]) * at.strides[axis];
  }
  return cell;
}

/// The two bytes of an axis; what is lower or higher than they can tell counts as their limit.
inline LooseGrid::Bounds LooseGrid::boundsOnAxis(int axis, std::int32_t low, std::int32_t high) {
  const auto in_cell = [](std::int32_t step) {
    return static_cast<Bounds>(std::clamp(step, 0, kLastInCell));
  };
  return (in_cell(high) | (kLastInCell - in_cell(low)) << 8) << 16 * axis;
}

/// In the cell of a body, which is part of the extent.
LooseGrid::Bounds LooseGrid::boundsOf(const Extent& extent, const Extent& body) const {
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
  Bounds bounds = kNobody | kSomebody;
  for (int axis = 0; axis < 3; ++axis) bounds |= boundsOnAxis(axis, low[axis], high[axis]);
  return bounds;
}

void LooseGrid::reach(const Extent& extent) {
  const std::uint32_t level = levelOf(extent);
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

/// Where a body lies that is in the cell.
LooseGrid::Place LooseGrid::find(std::uint32_t cell, std::uint32_t body) {
  for (Line* line = &lines_[cell];; line = &lines_[line->next]) {
    for (std::uint32_t place = 0; place < Line::kPlaces; ++place) {
      if (line->bodies[place] == body && line->bounds[place] != kNobody) return {line, place};
    }
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
  if (last == 0 && own.next != kNowhere) {
    free_lines_.push_back(own.next);
    own = lines_[own.next];
  }
}

void LooseGrid::addMoves(std::span<const std::uint32_t> bodies, std::span<const Aabb> boxes) {
  moves_.assign(bodies.begin(), bodies.end());
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (i + kPrefetchAhead < bodies.size()) {
      prefetch(&boxes[bodies[i + kPrefetchAhead]]);
      prefetch(&bodies_[bodies[i + kPrefetchAhead]]);
    }
    const std::uint32_t body = bodies[i];
    const Aabb& box = boxes[body];
    const bool was = bodies_[body].cell() != kNowhere;
    const bool is = !isEmpty(box);
    std::uint32_t cell = kNowhere;
    if (is) {
      const Extent extent = extentOf(box);
      cell = cellOf(extent);
      reach(extent);
    }
    bodies_[body].move(box, cell, frame_);
    if (was || is) to_move_[body / 64] |= std::uint64_t{1} << body % 64;
  }
}

void LooseGrid::makeMove(const Step& step) {
  const Body& body = bodies_[step.body];
  if (body.cell() == body.cellBefore()) {
    const Place place = find(body.cell(), step.body);
    place.line->bounds[place.place] = step.bounds;
    return;
  }
  ++work_.cell_changes;
  if (body.cellBefore() != kNowhere) left_.push_back({step.body, body.cellBefore()});
  if (body.cell() != kNowhere) insert(body.cell(), step.body, step.bounds);
}

/// Adds to the next batch what is to be done for the body.
void LooseGrid::prepare(std::uint32_t index) {
  const Body& body = bodies_[index];
  const bool was = body.cellBefore() != kNowhere;
  const bool is = body.cell() != kNowhere;
  if (!was && !is) return;
  const Extent before = extentOf(body.before);
  const Extent now = extentOf(body.box);
  // Around both places at once, unless it has moved far.
  const Steps far = 1 << kCellBits | now.edges();
  const auto is_near = [&](Steps from, Steps to) {
    return isEveryAxis((to - from <= far) & (from - to <= far));
  };
  const bool near = is_near(before.min, now.min) && is_near(before.max, now.max);
  const Extent both = {smaller(before.min, now.min), larger(before.max, now.max)};
  // In a cell that it does not leave it is found at both places.
  const Extent& found = body.cell() == body.cellBefore() ? both : now;
  next_batch_.steps.push_back({index, boundsOf(found, now)});
  if (near) return lookAround(index, both, kBeginnings | kEnds);
  if (was) lookAround(index, before, kEnds);
  if (is) lookAround(index, now, kBeginnings);
}

/// Adds looks into the cells where somebody may overlap the extent.
void LooseGrid::lookAround(std::uint32_t body, const Extent& extent, unsigned wanted) {
  LargeArray<Look>& looks = next_batch_.looks;
  for (std::uint32_t levels = used_levels_; levels != 0; levels &= levels - 1) {
    const auto level = static_cast<std::uint32_t>(std::countr_zero(levels));
    lookAlongAxes(level, extent);
    const auto& [columns, rows, slices] = looks_on_axes_;
    std::size_t look = looks.size();
    looks.resize(look + columns.size() * rows.size() * slices.size());
    for (const LookOnAxis& slice : slices) {
      for (const LookOnAxis& row : rows) {
        const std::uint32_t first = levels_[level].first_cell + slice.cell + row.cell;
        const Bounds least = kSomebody | slice.least | row.least;
        for (const LookOnAxis& column : columns) {
          prefetch(&lines_[first + column.cell]);
          looks[look++] = {least | column.least, first + column.cell};
        }
      }
    }
  }
  next_batch_.searches.push_back({body, wanted, looks.size(), 0});
}

/// Finds the cells on each axis where somebody may overlap the extent, and what bounds must reach
/// there.
void LooseGrid::lookAlongAxes(std::uint32_t level, const Extent& extent) {
  constexpr std::int32_t kFarOff = std::numeric_limits<std::int32_t>::max();
  const Level& at = levels_[level];
  const Steps first = (extent.min - at.reach) >> shiftOf(level);
  const Steps last = extent.max >> shiftOf(level);
  const int to_level = shiftOf(level) - kCellBits;
  const Steps begin = first << kCellBits;
  // Beyond the bulk bounds tell nothing.
  const Steps in_bulk = (first >= at.first) & (last - at.first < at.counts);
  const Steps low = in_bulk & ((extent.min >> to_level) - begin);
  const Steps high = in_bulk ? (extent.max >> to_level) - begin : Steps{} + kFarOff;
  // Where that is all there are, each once.
  const Steps counts = smaller(last - first + 1, at.counts);
  for (int axis = 0; axis < 3; ++axis) {
    LargeArray<LookOnAxis>& looks = looks_on_axes_[axis];
    looks.resize(static_cast<std::size_t>(counts[axis]));
    const auto end = static_cast<std::uint32_t>(at.counts[axis]);
    std::uint32_t cell = wrapped(first[axis], at.first[axis], at.counts[axis]);
    std::int32_t before = 0;  // from the beginning of the first cell to that of this one
    for (LookOnAxis& look : looks) {
      look = {boundsOnAxis(axis, high[axis] - before, low[axis] - before), cell * at.strides[axis]};
      before += 1 << kCellBits;
      cell = cell + 1 == end ? 0 : cell + 1;
    }
  }
}

/// Lists who is there and reaches what was wanted, and sends for them.
void LooseGrid::lookInto(const Look& look) {
  for (const Line* line = &lines_[look.cell];; line = &lines_[line->next]) {
    for (std::uint32_t place = 0; place < Line::kPlaces; ++place) {
      if (!reaches(line->bounds[place], look.least)) continue;
      prefetch(&bodies_[line->bodies[place]]);
      candidates_.push_back({line->bodies[place], look.cell});
    }
    ++work_.lines;
    if (line->next == kNowhere) break;
  }
}

void LooseGrid::settle() {
  for (const Left& left : left_) {
    remove(left.cell, left.body);
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
    if (isToMove(body)) return fmt::format("body {} has not moved", body);
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
