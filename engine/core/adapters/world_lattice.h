// Worlds at the same place put side by side, for algorithms that handle only boxes.
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
/// scene's world. Boxes that overlap still do: rounding is monotone. Other boxes may come to
/// overlap, among them those of bodies of two worlds that poke out.
class WorldLattice {
 public:
  /// The lattice is a cube of worlds, or as near to a cube as their number allows.
  explicit WorldLattice(const SceneInfo& scene) : world_(scene.world) {
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
      const std::array<std::size_t, 3> place = {number % per_axis, number / per_axis % per_axis,
                                                number / per_axis / per_axis};
      std::array<float, 3>& offset = offsets_.emplace_back();
      for (int axis = 0; axis < 3; ++axis) {
        offset[axis] = step[axis] * static_cast<float>(place[axis]);
      }
    }
    for (const std::uint32_t world : worlds) {
      numbers_.push_back(
          static_cast<std::uint32_t>(std::ranges::lower_bound(present, world) - present.begin()));
    }
  }

  /// False for one world, or worlds too large to be moved.
  [[nodiscard]] bool moves() const { return !offsets_.empty(); }
  [[nodiscard]] Aabb moved(std::uint32_t body, Aabb box) const {
    const std::array<float, 3>& offset = offsets_[numbers_[body]];
    for (int axis = 0; axis < 3; ++axis) {
      box.min[axis] += offset[axis];
      box.max[axis] += offset[axis];
    }
    return box;
  }
  /// The bounds of all worlds: the scene's own if no world moves.
  [[nodiscard]] const Aabb& world() const { return world_; }

 private:
  /// Distance between worlds, in extents of a world: bodies may poke out a little.
  static constexpr float kSpacing = 1.25F;

  /// The offset of a box within this does not overflow.
  static constexpr float kMaxExtent = 1e30F;

  std::vector<std::uint32_t> numbers_;  ///< by body: its world, numbered without gaps
  std::vector<std::array<float, 3>> offsets_;
  Aabb world_;
};

}  // namespace broadmark
