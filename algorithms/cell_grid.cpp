// Fits a grid to boxes. The region is based on quantiles of a sample and not on the bounds: a
// single body outside the world would otherwise leave all others in one cell.

#include "cell_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sample.h"

namespace broadmark {
namespace {

constexpr std::size_t kSample = 256;
/// Cells per axis: far below the precision of a float.
constexpr double kMaxCells = 1 << 20;

/// The upper quartile of the edges.
double usualEdge(std::span<const Aabb> sample, int axis) {
  std::array<double, kSample> edges;
  const auto end = std::ranges::transform(sample, edges.begin(), [=](const Aabb& box) {
                     return double{box.max[axis]} - double{box.min[axis]};
                   }).out;
  const auto at = edges.begin() + static_cast<std::ptrdiff_t>((sample.size() - 1) * 3 / 4);
  std::nth_element(edges.begin(), at, end);
  return *at;
}

/// The edge of cubic cells, `cells` of them, that fill the extents. An axis shorter than a cell (or
/// 0) is not cut, and the cells are divided among the others.
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

CellGrid::CellGrid(const Aabb& world, std::int32_t cells_per_axis) {
  for (int axis = 0; axis < 3; ++axis) {
    const double low = world.min[axis];
    cut(axis, low, world.max[axis] - low, cells_per_axis);
  }
}

void CellGrid::fit(std::span<const Aabb> boxes, std::size_t cells, bool columns) {
  *this = {};
  if (boxes.empty()) return;
  std::array<Aabb, kSample> memory;
  const std::span sample = std::span(memory).first(std::min(boxes.size(), kSample));
  for (std::size_t i = 0; i < sample.size(); ++i) {
    sample[i] = boxes[sampleIndex(i, sample.size(), boxes.size())];
  }
  std::array<TrimmedRange, 3> bulk;
  std::array<double, 3> extents{};
  for (int axis = 0; axis < 3; ++axis) {
    if (columns && axis == 1) continue;
    bulk[axis] = trimmedRange(sample, axis);
    extents[axis] = bulk[axis].extent();
  }
  const double side = cellSide(extents, static_cast<double>(std::max<std::size_t>(cells, 1)));
  for (int axis = 0; axis < 3; ++axis) {
    const double length = std::max(side, 2 * usualEdge(sample, axis));
    const double count = std::min(std::round(extents[axis] / length), kMaxCells);
    // False, too, for no extent: 0/0.
    if (count >= 2) cut(axis, bulk[axis].low, extents[axis], count);
  }
}

void CellGrid::cut(int axis, double low, double extent, double count) {
  constexpr double kMaxScale = std::numeric_limits<float>::max();
  counts_[axis] = static_cast<std::int32_t>(count);
  last_[axis] = static_cast<float>(counts_[axis] - 1);
  low_[axis] = static_cast<float>(low);
  scale_[axis] = extent > 0 ? static_cast<float>(std::min(count / extent, kMaxScale)) : 0;
}

Aabb CellGrid::cell(std::size_t index, const Aabb& bounds) const {
  Aabb box = bounds;
  const CellPosition at = position(index);
  for (int axis = 0; axis < 3; ++axis) {
    const auto side = [&](std::int32_t k) {
      return static_cast<float>(low_[axis] + static_cast<double>(k) / scale_[axis]);
    };
    if (at[axis] > 0) box.min[axis] = std::max(box.min[axis], side(at[axis]));
    if (at[axis] + 1 < counts_[axis]) {
      box.max[axis] = std::min(box.max[axis], side(at[axis] + 1));
    }
  }
  return box;
}

}  // namespace broadmark
