#include "scenes/course.h"

#include <algorithm>
#include <cmath>

namespace broadmark::scenes {

Pose Course::poseAt(float along) const {
  Pose pose{.position = lane};
  pose.position[axis] = along;
  return pose;
}

Vec3 Course::velocityAt(const Vec3& position) const {
  constexpr float kPull = 2;  // per second
  Vec3 velocity;
  for (int i = 0; i < 3; ++i) velocity[i] = kPull * (lane[i] - position[i]);
  velocity[axis] = speed;
  return velocity;
}

float farthestInside(const Shape& shape, double side) {
  const auto corner = tightBox(shape, {}).max;
  const double reach = std::hypot(corner[0], corner[1], corner[2]);
  return static_cast<float>(std::max(0.0, side / 2 - reach));
}

double powerLawSize(double max_size, Random& random) {
  // The fraction of bodies larger than x is 1/x³.
  return std::min(1 / std::cbrt(1 - random.uniform()), std::max(1.0, max_size));
}

}  // namespace broadmark::scenes
