// Joint translation, rotation and scaling of bodies about a point.
#pragma once

#include "broadmark/scenes/authored_scene.h"

namespace broadmark::scenes {

/// Scales bodies about a centre, then rotates them about it, then translates them.
struct Transformation {
  Vec3 centre{};
  Quaternion axes{0, 0, 0, 1};  ///< of unit length: rotates the world's axes to those of `scale`
  Vec3 scale{1, 1, 1};          ///< factors above 0
  Quaternion turn{0, 0, 0, 1};  ///< of unit length
  Vec3 move{};                  ///< in world units, along the world's axes
};

Pose transformedPose(const AuthoredBody&, const Transformation&);
/// The shape after the transformation. Each edge of a box grows by the factor in its direction. A
/// sphere stays a sphere and grows by the geometric mean of the factors, as its volume requires.
Shape transformedShape(const AuthoredBody&, const Transformation&);

/// A rotation as angles in degrees, about the world's axes x, y and z, in this order.
Vec3 anglesOf(const Quaternion& rotation);
Quaternion rotationBy(const Vec3& angles);

}  // namespace broadmark::scenes
