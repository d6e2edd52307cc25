#include "broadmark/pose.h"

#include <Eigen/Geometry>

namespace broadmark {

Vec3 rotatedExtents(const Vec3& half_extents, const Quaternion& rotation) {
  const Eigen::Matrix3f matrix = Eigen::Quaternionf(rotation.data()).toRotationMatrix();
  const Eigen::Vector3f extents = matrix.cwiseAbs() * Eigen::Vector3f(half_extents.data());
  return {extents.x(), extents.y(), extents.z()};
}

}  // namespace broadmark
