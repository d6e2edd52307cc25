#include "broadmark/scenes/shape.h"

namespace broadmark::scenes {

Vec3 edgesOf(const Shape& shape) {
  if (const auto* sphere = std::get_if<SphereShape>(&shape)) {
    return {2 * sphere->radius, 2 * sphere->radius, 2 * sphere->radius};
  }
  const auto& [x, y, z] = std::get<BoxShape>(shape).half_extents;
  return {2 * x, 2 * y, 2 * z};
}

Aabb tightBox(const Shape& shape, const Pose& pose) {
  if (const auto* sphere = std::get_if<SphereShape>(&shape)) {
    return boxAround(pose.position, {sphere->radius, sphere->radius, sphere->radius});
  }
  return boxAround(pose.position,
                   rotatedExtents(std::get<BoxShape>(shape).half_extents, pose.rotation));
}

}  // namespace broadmark::scenes
