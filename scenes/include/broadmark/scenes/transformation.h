// Moving, turning and scaling bodies together, about a point.
#pragma once

#include "broadmark/scenes/authored_scene.h"

namespace broadmark::scenes {

/// What becomes of bodies: they are scaled about a centre, then turned about it, then moved.
struct Transformation {
  Vec3 centre{};
  Quaternion axes{0, 0, 0, 1};  ///< of unit length: turns the world's axes to those of `scale`
  Vec3 scale{1, 1, 1};          ///< factors above 0
  Quaternion turn{0, 0, 0, 1};  ///< of unit length
  Vec3 move{};                  ///< in world units, along the world's axes
};

/// Where the body is after that.
Pose transformedPose(const AuthoredBody&, const Transformation&);
/// Its shape after that. Boxes stay boxes and spheres stay spheres: each edge of a box becomes as
/// long as scaling makes it, and a sphere takes the factor of its volume.
Shape transformedShape(const AuthoredBody&, const Transformation&);

}  // namespace broadmark::scenes
