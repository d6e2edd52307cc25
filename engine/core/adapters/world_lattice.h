// Lays out overlapping worlds side by side, for algorithms that handle only boxes.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "broadmark/frame.h"

namespace broadmark {

/// Translates the boxes of each world to a separate cell of a lattice; a cell is as large as the
/// scene's world. Overlapping boxes still overlap, since rounding is monotone. Translation may add
/// overlaps, also between bodies that protrude from two worlds.
class WorldLattice {
 public:
  /// Makes the lattice as close to a cube as the number of worlds allows.
  [[gnu::cold]] explicit WorldLattice(const SceneInfo& scene) : world_(scene.world) {
    const std::span<const std::uint32_t> worlds = scene.filter.worlds();
    std::vector<std::uint32_t> present(worlds.begin(), worlds.end());
    std::ranges::sort(present);
    present.erase(std::unique(present.begin(), present.end()), present.end());
    if (present.size() < 2) return;

    auto per_axis = static_cast<std::size_t>(std::cbrt(static_cast<double>(present.size())));
    while (per_axis * per_axis * per_axis < present.size()) ++per_axis;
    Aabb all = scene.world;
    std::array<float, 3> step{};
    for (int axis = 0; axis < 3; ++axis) {
      step[axis] = kSpacing * (scene.world.max[axis] - scene.world.min[axis]);
      all.max[axis] += step[axis] * static_cast<float>(per_axis - 1);
      if (!(std::abs(all.max[axis]) < kMaxExtent)) return;
    }

    world_ = all;
    for (std::size_t number = 0; number < present.size(); ++number) {
      const std::array<std::size_t, 3> cell = {number % per_axis, number / per_axis % per_axis,
                                               number / per_axis / per_axis};
      std::array<float, 3>& offset = offsets_.emplace_back();
      for (int axis = 0; axis < 3; ++axis) {
        offset[axis] = step[axis] * static_cast<float>(cell[axis]);
      }
    }
    for (const std::uint32_t world : worlds) {
      numbers_.push_back(
          static_cast<std::uint32_t>(std::ranges::lower_bound(present, world) - present.begin()));
    }
  }

  /// False for a single world, and for worlds too large to be translated.
  [[nodiscard]] bool translates() const { return !offsets_.empty(); }
  [[nodiscard]] Aabb translated(std::uint32_t body, Aabb box) const {
    const std::array<float, 3>& offset = offsets_[numbers_[body]];
    for (int axis = 0; axis < 3; ++axis) {
      box.min[axis] += offset[axis];
      box.max[axis] += offset[axis];
    }
    return box;
  }
  /// The bounds of all worlds: the scene's own without translation.
  [[nodiscard]] const Aabb& world() const { return world_; }

 private:
  /// Distance between worlds, in extents of a world: bodies may protrude a little.
  static constexpr float kSpacing = 1.25F;

  /// The maximum coordinate of the lattice: no translated box overflows.
  static constexpr float kMaxExtent = 1e30F;

  std::vector<std::uint32_t> numbers_;  ///< by body: the index of its world
  std::vector<std::array<float, 3>> offsets_;
  Aabb world_;
};

}  // namespace broadmark
