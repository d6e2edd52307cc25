#include "broadmark/scenes/shape.h"

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

Aabb tightBox(const Shape& shape, const Pose& pose) {
  const Vec3 half = std::visit([&](const auto& kind) { return reach(kind, pose.rotation); }, shape);
  return boxAround(pose.position, half);
}

}  // namespace broadmark::scenes
