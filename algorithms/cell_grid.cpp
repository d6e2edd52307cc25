// Fitting a grid to boxes. The region is taken from quantiles of a sample and not from the bounds:
// one body that has fallen out of the world would otherwise leave all others in one cell.

#include "cell_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sample.h"

namespace broadmark {
namespace {

constexpr std::size_t kSample = 256;
/// Cells on one axis: far fewer than the integers that a float can tell apart.
constexpr double kMostCells = 1 << 20;

/// What a sample of the boxes tells about one axis. In double: there no float overflows.
struct AxisSample {
  double low = 0;
  double high = 0;
  double edge = 0;  ///< three quarters of the boxes are no longer
};

/// The value below which `part` of the values lie, which get rearranged.
double quantileOf(std::span<double> values, double part) {
  const auto last = static_cast<double>(values.size() - 1);
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(part * last);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

AxisSample sampleAxis(std::span<const Aabb> boxes, int axis) {
  std::array<double, kSample> centre_memory{};
  std::array<double, kSample> edge_memory{};
  const std::size_t count = std::min(boxes.size(), kSample);
  const std::span centres(centre_memory.data(), count);
  const std::span edges(edge_memory.data(), count);
  for (std::size_t i = 0; i < count; ++i) {
    const Aabb& box = boxes[sampled(i, count, boxes.size())];
    centres[i] = centreOf(box, axis);
    edges[i] = double{box.max[axis]} - double{box.min[axis]};
  }
  // Where nine tenths of the centres lie, and a quarter of that more on both sides: for most
  // distributions that holds nearly everything.
  const double low = quantileOf(centres, 0.05);
  const double high = quantileOf(centres, 0.95);
  const double edge = quantileOf(edges, 0.75);
  const double more = (high - low) / 4 + edge;
  return {low - more, high + more, edge};
}

/// The edge of cubic cells, `cells` of them, that fill the extents. An axis shorter than a cell
/// (or 0) is not cut, and the others share the cells among them.
double cellSide(std::array<double, 3> extents, double cells) {
  std::ranges::sort(extents, std::ranges::greater());
  double side = extents[0];
  double volume = 1;
  for (int axes = 1; axes <= 3 && extents[axes - 1] > 0; ++axes) {
    volume *= extents[axes - 1];
    const double wanted = std::pow(volume / cells, 1.0 / axes);
    if (axes > 1 && wanted > extents[axes - 1]) break;
    side = wanted;
  }
  return side;
}

}  // namespace

void CellGrid::fit(std::span<const Aabb> boxes, const Aabb& bounds, std::size_t cells,
                   bool columns) {
  *this = {};
  if (boxes.empty()) return;
  std::array<AxisSample, 3> samples;
  std::array<double, 3> extents{};
  for (int axis = 0; axis < 3; ++axis) {
    if (columns && axis == 1) continue;
    AxisSample& sample = samples[axis] = sampleAxis(boxes, axis);
    sample.low = std::max<double>(sample.low, bounds.min[axis]);
    sample.high = std::min<double>(sample.high, bounds.max[axis]);
    extents[axis] = sample.high - sample.low;
  }
  const double side = cellSide(extents, static_cast<double>(std::max<std::size_t>(cells, 1)));
  for (int axis = 0; axis < 3; ++axis) {
    const double length = std::max(side, 2 * samples[axis].edge);
    const double count = std::min(std::round(extents[axis] / length), kMostCells);
    if (!(count >= 2)) continue;  // also when there is no extent: 0/0
    constexpr double kMost = std::numeric_limits<float>::max();
    counts_[axis] = static_cast<std::int32_t>(count);
    last_[axis] = static_cast<float>(counts_[axis] - 1);
    low_[axis] = static_cast<float>(samples[axis].low);
    scale_[axis] = static_cast<float>(std::min(count / extents[axis], kMost));
  }
}

Aabb CellGrid::cell(std::size_t index, const Aabb& bounds) const {
  Aabb box = bounds;
  for (int axis = 0; axis < 3; ++axis) {
    const auto count = static_cast<std::size_t>(counts_[axis]);
    const std::size_t at = index % count;
    index /= count;
    const auto side = [&](std::size_t k) {
      return static_cast<float>(low_[axis] + static_cast<double>(k) / scale_[axis]);
    };
    if (at > 0) box.min[axis] = std::max(box.min[axis], side(at));
    if (at + 1 < count) box.max[axis] = std::min(box.max[axis], side(at + 1));
  }
  return box;
}

}  // namespace broadmark
