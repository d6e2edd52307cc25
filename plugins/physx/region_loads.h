// Counts the bodies in MBP's regions. A region has sixteen-bit indices, also for bodies that leave
// it in the current frame; above this limit PhysX loses pairs, not always with an error.
#pragma once

#include <PxPhysicsAPI.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "broadmark/error.h"

namespace broadmark {

/// A grid of `count` by `count` regions over two axes of a world. The outer regions are unbounded.
class RegionLoads {
 public:
  /// `axes`: the axes that are divided.
  RegionLoads(const Aabb& world, std::array<int, 2> axes, int count, std::size_t bodies)
      : axes_(axes),
        count_(count),
        ranges_(bodies),
        loads_(static_cast<std::size_t>(count * count)) {
    for (std::size_t side = 0; side < 2; ++side) {
      const int axis = axes[side];
      for (int k = 1; k < count; ++k) {
        borders_[side].push_back(world.min[axis] + (world.max[axis] - world.min[axis]) *
                                                       static_cast<float>(k) /
                                                       static_cast<float>(count));
      }
    }
  }

  [[nodiscard]] int count() const { return count_; }
  /// The bounds of region k on the first or the second axis.
  [[nodiscard]] float low(std::size_t side, int k) const {
    return k == 0 ? -PX_MAX_BOUNDS_EXTENTS : borders_[side][static_cast<std::size_t>(k) - 1];
  }
  [[nodiscard]] float high(std::size_t side, int k) const {
    return k + 1 == count_ ? PX_MAX_BOUNDS_EXTENTS : borders_[side][static_cast<std::size_t>(k)];
  }

  /// Moves or adds a body. Until endFrame(), the body also counts in the regions that it left.
  void move(std::uint32_t body, const physx::PxBounds3& bounds) {
    const Range now = rangeOf(bounds);
    const Range before = ranges_[body];
    forEachRegion(now, [&](int i, int j) {
      if (!before.holds(i, j)) enter(i, j);
    });
    forEachRegion(before, [&](int i, int j) {
      if (!now.holds(i, j)) departures_.push_back(indexOf(i, j));
    });
    ranges_[body] = now;
  }
  void remove(std::uint32_t body) {
    forEachRegion(ranges_[body], [&](int i, int j) { departures_.push_back(indexOf(i, j)); });
    ranges_[body] = {};
  }
  /// Removes departed bodies from the counts.
  void endFrame() {
    for (const std::size_t region : departures_) --loads_[region];
    departures_.clear();
  }

 private:
  /// The regions from `first` to `last` on each axis; empty by default.
  struct Range {
    std::array<std::int8_t, 2> first = {0, 0};
    std::array<std::int8_t, 2> last = {-1, -1};

    [[nodiscard]] bool holds(int i, int j) const {
      return first[0] <= i && i <= last[0] && first[1] <= j && j <= last[1];
    }
  };

  /// PhysX rounds borders and bounds outward by less than this relative error.
  static constexpr float kRounding = 1e-5F;

  [[nodiscard]] Range rangeOf(const physx::PxBounds3& bounds) const {
    Range range;
    for (std::size_t side = 0; side < 2; ++side) {
      const auto axis = static_cast<unsigned>(axes_[side]);
      const float low = bounds.minimum[axis];
      const float high = bounds.maximum[axis];
      const std::vector<float>& borders = borders_[side];
      const auto below = std::ranges::lower_bound(borders, low - kRounding * std::abs(low));
      const auto above = std::ranges::upper_bound(borders, high + kRounding * std::abs(high));
      range.first[side] = static_cast<std::int8_t>(below - borders.begin());
      range.last[side] = static_cast<std::int8_t>(above - borders.begin());
    }
    return range;
  }

  template <class Visit>
  static void forEachRegion(const Range& range, Visit visit) {
    for (int i = range.first[0]; i <= range.last[0]; ++i) {
      for (int j = range.first[1]; j <= range.last[1]; ++j) visit(i, j);
    }
  }

  [[nodiscard]] std::size_t indexOf(int i, int j) const {
    return static_cast<std::size_t>(i * count_ + j);
  }

  void enter(int i, int j) {
    constexpr std::uint32_t kMaxLoad = 0xFFFF;
    if (++loads_[indexOf(i, j)] < kMaxLoad) return;
    throw UnsupportedError(
        "PhysX's MBP: a region holds up to 65,534 bodies, including those that leave it in the "
        "same frame");
  }

  std::array<int, 2> axes_;
  int count_;
  std::array<std::vector<float>, 2> borders_;
  std::vector<Range> ranges_;  ///< by body
  std::vector<std::uint32_t> loads_;
  std::vector<std::size_t> departures_;  ///< the region of each departure in this frame
};

}  // namespace broadmark
