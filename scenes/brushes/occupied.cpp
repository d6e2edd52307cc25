// One hash grid for each power of two of box sizes. So neither a floor under thousands of small
// bodies nor dust among large ones crowds a cell.

#include "brushes/occupied.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace broadmark::scenes {

void BoxGrid::add(const Aabb& box) {
  if (boxes_.size() == first_.size()) growTable();
  boxes_.push_back({box, kNone});
  chain(static_cast<std::uint32_t>(boxes_.size() - 1));
}

bool BoxGrid::overlaps(const Aabb& box) const {
  Cell low;
  Cell high;
  double cells = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    low[axis] = indexOf(box.min[axis] - reach_);
    high[axis] = indexOf(box.max[axis]);
    cells *= static_cast<double>(high[axis] - low[axis] + 1);
  }
  if (cells > static_cast<double>(boxes_.size())) {
    return std::ranges::any_of(
        boxes_, [&](const Entry& entry) { return broadmark::overlaps(entry.box, box); });
  }
  for (std::int64_t x = low[0]; x <= high[0]; ++x) {
    for (std::int64_t y = low[1]; y <= high[1]; ++y) {
      for (std::int64_t z = low[2]; z <= high[2]; ++z) {
        if (overlapsInBucket(bucketOf({x, y, z}), box)) return true;
      }
    }
  }
  return false;
}

std::int64_t BoxGrid::indexOf(double coordinate) const {
  return static_cast<std::int64_t>(std::floor(coordinate / edge_));
}

std::size_t BoxGrid::bucketOf(const Cell& cell) const {
  std::uint64_t hash = 0;
  for (const std::int64_t index : cell) {
    hash = (hash ^ static_cast<std::uint64_t>(index)) * 0x9E3779B97F4A7C15U;
    hash ^= hash >> 32;
  }
  return hash & (first_.size() - 1);
}

bool BoxGrid::overlapsInBucket(std::size_t bucket, const Aabb& box) const {
  for (std::uint32_t i = first_[bucket]; i != kNone; i = boxes_[i].next) {
    if (broadmark::overlaps(boxes_[i].box, box)) return true;
  }
  return false;
}

void BoxGrid::chain(std::uint32_t index) {
  Entry& entry = boxes_[index];
  const auto& [x, y, z, unused] = entry.box.min;
  std::uint32_t& first = first_[bucketOf({indexOf(x), indexOf(y), indexOf(z)})];
  entry.next = std::exchange(first, index);
}

void BoxGrid::growTable() {
  first_.assign(std::max<std::size_t>(2 * first_.size(), 64), kNone);
  for (std::uint32_t i = 0; i < boxes_.size(); ++i) chain(i);
}

namespace {

/// The exponent of the least power of two above all edges.
int exponentOf(const Aabb& box) {
  float longest = 0;
  for (int axis = 0; axis < 3; ++axis) {
    longest = std::max(longest, box.max[axis] - box.min[axis]);
  }
  int exponent = 0;
  std::frexp(longest, &exponent);
  return exponent;
}

}  // namespace

void Occupied::add(const Aabb& box) {
  const int exponent = exponentOf(box);
  grids_.try_emplace(exponent, std::ldexp(1.0, exponent)).first->second.add(box);
}

bool Occupied::overlaps(const Aabb& box) const {
  return std::ranges::any_of(grids_, [&](const auto& grid) { return grid.second.overlaps(box); });
}

}  // namespace broadmark::scenes
