#include "scenes/pose.h"

#include <Eigen/Geometry>

namespace broadmark::scenes {
namespace {

/// Half the size of the box around a shape turned by `rotation`.
Eigen::Vector3f reach(const BoxShape& box, const Eigen::Matrix3f& rotation) {
  return rotation.cwiseAbs() * Eigen::Vector3f(box.half_extents.data());
}

}  // namespace

Aabb tightBox(const Shape& shape, const Pose& pose) {
  const Eigen::Matrix3f rotation = Eigen::Quaternionf(pose.rotation.data()).toRotationMatrix();
  const Eigen::Vector3f half =
      std::visit([&](const auto& kind) { return reach(kind, rotation); }, shape);
  Aabb box;
  for (int axis = 0; axis < 3; ++axis) {
    box.min[axis] = pose.position[axis] - half[axis];
    box.max[axis] = pose.position[axis] + half[axis];
  }
  return box;
}

}  // namespace broadmark::scenes
