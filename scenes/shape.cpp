#include "broadmark/scenes/shape.h"

#include <type_traits>

namespace broadmark::scenes {
namespace {

/// Half the size of the box around a shape turned by `rotation`.
Vec3 reach(const BoxShape& box, const Quaternion& rotation) {
  return turnedExtents(box.half_extents, rotation);
}

Vec3 reach(const SphereShape& sphere, const Quaternion&) {
  return {sphere.radius, sphere.radius, sphere.radius};
}

}  // namespace

Vec3 edgesOf(const Shape& shape) {
  const auto edges = [](const auto& kind) -> Vec3 {
    if constexpr (std::is_same_v<std::decay_t<decltype(kind)>, BoxShape>) {
      const auto& [x, y, z] = kind.half_extents;
      return {2 * x, 2 * y, 2 * z};
    } else {
      return {2 * kind.radius, 2 * kind.radius, 2 * kind.radius};
    }
  };
  return std::visit(edges, shape);
}

Aabb tightBox(const Shape& shape, const Pose& pose) {
  const Vec3 half = std::visit([&](const auto& kind) { return reach(kind, pose.rotation); }, shape);
  return boxAround(pose.position, half);
}

}  // namespace broadmark::scenes
