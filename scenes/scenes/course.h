// Bodies driven along straight lines regardless of forces; positions and sizes of bodies.
#pragma once

#include "broadmark/scenes/physics_engine.h"
#include "broadmark/scenes/random.h"

namespace broadmark::scenes {

/// A line along one axis, and the speed on it.
struct Course {
  int axis = 0;     ///< 0, 1, 2: x, y, z
  float speed = 0;  ///< along the axis; negative: backwards
  Vec3 lane{};      ///< a point of the line

  /// The body's pose at `along` on the line, unrotated.
  [[nodiscard]] Pose poseAt(float along) const;
  /// The velocity of a body at `position` that follows the line: its speed, and a gentle pull back
  /// to the line after collisions.
  [[nodiscard]] Vec3 velocityAt(const Vec3& position) const;
};

/// The maximum coordinate of a body's centre such that the body is inside a world of this side in
/// any rotation; 0 for a body larger than the world.
float farthestInside(const Shape&, double side);

/// A random size from 1 to `max_size` (at least 1). Doubling the size divides the number of bodies
/// by eight: all sizes fill about the same volume.
double powerLawSize(double max_size, Random&);

}  // namespace broadmark::scenes
