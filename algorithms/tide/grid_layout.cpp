#include "tide/grid_layout.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <vector>

namespace broadmark::tide {
namespace {

/// The cost of visiting a cell, in box tests.
constexpr double kCellCost = 2;
/// Ratio between successive cell lengths tried.
constexpr double kShrinkFactor = 0.7;

/// Mean and 90th percentile of the edge lengths on an axis.
struct Edges {
  double mean = 0;
  double percentile90 = 0;
};

Edges edgesOf(std::span<const Aabb> sample, int axis) {
  std::vector<double> edges;
  double sum = 0;
  for (const Aabb& box : sample) {
    edges.push_back(static_cast<double>(box.max[axis]) - static_cast<double>(box.min[axis]));
    sum += edges.back();
  }
  const auto percentile90 = edges.begin() + static_cast<std::ptrdiff_t>(edges.size() * 9 / 10);
  std::ranges::nth_element(edges, percentile90);
  return {sum / static_cast<double>(edges.size()), *percentile90};
}

std::vector<Aabb> sampleOf(std::span<const Aabb> boxes) {
  std::vector<Aabb> sample;
  takeSample(boxes.size(), [&](std::size_t i) -> const Aabb& { return boxes[i]; }, sample);
  std::erase_if(sample, isEmpty);
  return sample;
}

/// Mean number of other boxes in a box's cell. Cells are hashed: distant cells may be counted as
/// one.
double crowding(std::span<const Aabb> boxes, double edge) {
  const std::size_t size = std::bit_ceil(2 * boxes.size());
  std::vector<std::uint32_t> counts(size, 0);
  const double scale = 1 / edge;
  double others = 0;
  for (const Aabb& box : boxes) {
    if (isEmpty(box)) continue;
    std::uint64_t hash = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double cell = std::clamp(std::floor(box.min[axis] * scale), -1e15, 1e15);
      hash = (hash + static_cast<std::uint64_t>(static_cast<std::int64_t>(cell))) *
             0x9E37'79B9'7F4A'7C15;
      hash ^= hash >> 32;
    }
    others += 2 * counts[hash & (size - 1)]++;
  }
  return others / static_cast<double>(boxes.size());
}

}  // namespace

void GridLayout::fit(std::span<const Aabb> boxes) {
  const std::vector<Aabb> sample = sampleOf(boxes);
  std::array<TrimmedRange, 3> bulk;
  for (int axis = 0; axis < 3 && !sample.empty(); ++axis) bulk[axis] = trimmedRange(sample, axis);
  chooseCellSize(boxes, sample, bulk);
  layOutLevels(boxes, bulk);
}

/// Minimises the predicted cost of a query. The descent starts from large cells, which are right
/// for evenly spread bodies: clustered bodies need smaller ones.
void GridLayout::chooseCellSize(std::span<const Aabb> boxes, std::span<const Aabb> sample,
                                const std::array<TrimmedRange, 3>& bulk) {
  constexpr double kMaxBodiesPerCell = 4;
  constexpr double kMinEdge = 1e-30;
  constexpr double kMaxEdge = 1e30;
  double edge = 1;
  origin_ = {};
  if (!sample.empty()) {
    std::array<Edges, 3> edges;
    double longest = 0;
    for (int axis = 0; axis < 3; ++axis) {
      origin_[axis] = static_cast<float>(bulk[axis].low);
      longest = std::max(longest, bulk[axis].extent());
      edges[axis] = edgesOf(sample, axis);
    }
    const auto cells = [&](double cell_edge) {
      double product = 1;
      for (const TrimmedRange& on_axis : bulk)
        product *= std::max(1.0, on_axis.extent() / cell_edge);
      return product;
    };
    const double min_cells = static_cast<double>(boxes.size()) / kMaxBodiesPerCell;
    edge = std::clamp(longest, kMinEdge, kMaxEdge);
    while (cells(edge) < min_cells && edge > kMinEdge) edge *= kShrinkFactor;

    const auto cost = [&](double cell_edge) {
      double visits = 1;
      for (const Edges& on_axis : edges) {
        visits *= 1 + (on_axis.mean + std::min(on_axis.percentile90, cell_edge)) / cell_edge;
      }
      return visits * (kCellCost + crowding(boxes, cell_edge));
    };
    double min_cost = cost(edge);
    const auto improves = [&](double candidate) {
      if (candidate < kMinEdge) return false;
      const double candidate_cost = cost(candidate);
      if (candidate_cost >= min_cost) return false;
      min_cost = candidate_cost;
      edge = candidate;
      return true;
    };
    while (improves(edge * kShrinkFactor)) {
    }
    if (!improves(edge * std::sqrt(kShrinkFactor))) improves(edge / std::sqrt(kShrinkFactor));
  }
  scale_ = static_cast<float>((1 << kCellBits) / edge);
}

/// Covers the trimmed range, but with at most about twice as many cells as bodies.
void GridLayout::layOutLevels(std::span<const Aabb> boxes,
                              const std::array<TrimmedRange, 3>& bulk) {
  levels_ = {};
  used_levels_ = 0;
  std::array<std::uint32_t, kLevels> bodies{};
  for (const Aabb& box : boxes) {
    if (isEmpty(box)) continue;
    const GridBox grid_box = quantize(box);
    const std::uint32_t level = levelOf(grid_box);
    ++bodies[level];
    growLevel(grid_box, level);
  }
  GridCoord low{};
  GridCoord high{};
  for (int axis = 0; axis < 3; ++axis) {
    std::array<float, 4> corner = origin_;
    low[axis] = quantizeCorner(corner)[axis];
    corner[axis] = static_cast<float>(bulk[axis].high);
    high[axis] = quantizeCorner(corner)[axis];
  }
  cell_count_ = 0;
  for (std::uint32_t level = 0; level < kLevels; ++level) {
    Level& grid = levels_[level];
    for (int axis = 0; axis < 3; ++axis) {
      grid.origin[axis] = low[axis] >> cellShift(level);
      grid.dims[axis] = (high[axis] >> cellShift(level)) - grid.origin[axis] + 1;
    }
    const auto size = [&] { return 1.0 * grid.dims[0] * grid.dims[1] * grid.dims[2]; };
    while (size() > 2.0 * bodies[level] + 1) {
      int longest = 0;
      for (const int axis : {1, 2}) {
        if (grid.dims[axis] > grid.dims[longest]) longest = axis;
      }
      grid.dims[longest] = (grid.dims[longest] + 1) / 2;
    }
    grid.strides[0] = 1;
    for (const int axis : {1, 2}) {
      grid.strides[axis] = grid.strides[axis - 1] * grid.dims[axis - 1];
    }
    grid.base = cell_count_;
    cell_count_ += static_cast<std::uint32_t>(size());
  }
}

GridCoord GridLayout::wrapOutside(GridCoord from_origin, const Level& grid) {
  for (int axis = 0; axis < 3; ++axis) {
    from_origin[axis] %= grid.dims[axis];
    if (from_origin[axis] < 0) from_origin[axis] += grid.dims[axis];
  }
  return from_origin;
}

GridLayout::WrappedRange GridLayout::wrappedRange(const GridBox& query, std::uint32_t level) const {
  constexpr std::int32_t kUnbounded = std::numeric_limits<std::int32_t>::max();
  const Level& grid = levels_[level];
  const auto [first, last] = queryRange(query, level);
  const GridBox in_first = relativeToCell(first, query, level);
  // On an axis that wraps, the packed bounds cannot reject anything.
  const GridCoord is_unwrapped = (first >= grid.origin) & (last - grid.origin < grid.dims);
  return {.first = wrap(first, grid),
          .counts = smaller(last - first + 1, grid.dims),
          .query = {is_unwrapped & in_first.min,
                    is_unwrapped ? in_first.max : GridCoord{} + kUnbounded}};
}

Aabb GridLayout::cellBox(GridCoord cell, std::uint32_t level) const {
  const double edge = std::ldexp(1.0, cellShift(level)) / scale_;
  Aabb box;
  for (int axis = 0; axis < 3; ++axis) {
    box.min[axis] = static_cast<float>(origin_[axis] + edge * cell[axis]);
    box.max[axis] = static_cast<float>(origin_[axis] + edge * (cell[axis] + 1));
  }
  return box;
}

}  // namespace broadmark::tide
