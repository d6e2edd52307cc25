// Bodies that are driven along straight lines instead of being left to their forces.
#pragma once

#include "broadmark/scenes/physics_engine.h"

namespace broadmark::scenes {

/// A line along one axis, and the speed on it.
struct Course {
  int axis = 0;     ///< 0, 1, 2: x, y, z
  float speed = 0;  ///< along the axis; negative: backwards
  Vec3 lane{};      ///< a point of the line

  /// The body's pose at `along` on the line, unturned.
  [[nodiscard]] Pose poseAt(float along) const;
  /// What a body at `position` needs to follow the line: its speed, and a gentle pull back to the
  /// line, which collisions push it off.
  [[nodiscard]] Vec3 velocityAt(const Vec3& position) const;
};

/// The largest coordinate of the body's centre along `axis` at which a body of this shape, turned
/// anyhow, is inside a world of this side; 0 for a body larger than the world.
float farthestInside(const Shape&, double side);

}  // namespace broadmark::scenes
