// Worlds at the same place put side by side, for algorithms that know only boxes.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "broadmark/frame.h"

namespace broadmark {

/// Moves the boxes of each world to a place of its own in a lattice, as large as the scene's world.
/// Boxes that overlap do so afterwards: rounding never turns the order of two sums around. Others
/// may come to overlap, those of bodies of two worlds that poke out among them.
class SideBySide {
 public:
  explicit SideBySide(const SceneInfo& scene);

  /// False where there is one world, or worlds so large that they cannot be moved.
  [[nodiscard]] bool moves() const { return !offsets_.empty(); }
  [[nodiscard]] Aabb moved(std::uint32_t body, Aabb box) const {
    const std::array<float, 3>& offset = offsets_[numbers_[body]];
    for (int axis = 0; axis < 3; ++axis) {
      box.min[axis] += offset[axis];
      box.max[axis] += offset[axis];
    }
    return box;
  }
  /// What holds all worlds: the scene's own if nothing moves.
  [[nodiscard]] const Aabb& world() const { return world_; }

 private:
  std::vector<std::uint32_t> numbers_;  ///< by body: which of the worlds it is in, without gaps
  std::vector<std::array<float, 3>> offsets_;
  Aabb world_;
};

}  // namespace broadmark
