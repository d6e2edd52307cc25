// A cube of worlds, or as close to one as their number allows.

#include "adapters/side_by_side.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace broadmark {
namespace {

/// From one world to the next, in extents of a world: bodies may poke out a little.
constexpr float kSpacing = 1.25F;

/// Where this is added to a box, it stays as it is, or is far from overflowing.
constexpr float kFarthest = 1e30F;

}  // namespace

SideBySide::SideBySide(const SceneInfo& scene) : world_(scene.world) {
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
    if (!(std::abs(all.max[axis]) < kFarthest)) return;
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

}  // namespace broadmark
