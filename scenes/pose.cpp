#include "scenes/pose.h"

#include <Eigen/Geometry>

namespace broadmark::scenes {
namespace {

/// Half the size of the box around a shape turned by this unit quaternion.
Eigen::Vector3f reach(const BoxShape& box, const std::array<float, 4>& rotation) {
  const Eigen::Matrix3f matrix = Eigen::Quaternionf(rotation.data()).toRotationMatrix();
  return matrix.cwiseAbs() * Eigen::Vector3f(box.half_extents.data());
}

Eigen::Vector3f reach(const SphereShape& sphere, const std::array<float, 4>&) {
  return Eigen::Vector3f::Constant(sphere.radius);
}

}  // namespace

Aabb tightBox(const Shape& shape, const Pose& pose) {
  const Eigen::Vector3f half =
      std::visit([&](const auto& kind) { return reach(kind, pose.rotation); }, shape);
  Aabb box;
  for (int axis = 0; axis < 3; ++axis) {
    box.min[axis] = pose.position[axis] - half[axis];
    box.max[axis] = pose.position[axis] + half[axis];
  }
  return box;
}

}  // namespace broadmark::scenes
