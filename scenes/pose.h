// Poses and shapes of bodies, and the boxes around them.
#pragma once

#include <array>
#include <variant>

#include "broadmark/aabb.h"

namespace broadmark::scenes {

using Vec3 = std::array<float, 3>;

/// Where a body is and how it is turned.
struct Pose {
  Vec3 position{};                            ///< of the centre
  std::array<float, 4> rotation{0, 0, 0, 1};  ///< unit quaternion x y z w

  friend bool operator==(const Pose&, const Pose&) = default;
};

struct BoxShape {
  Vec3 half_extents{};
};

struct SphereShape {
  float radius = 0;
};

/// The form of a body around its centre.
using Shape = std::variant<BoxShape, SphereShape>;

/// The smallest axis-aligned box around the posed shape, with no margin: a turned box reaches
/// |R|·half extents from its centre, a sphere its radius.
Aabb tightBox(const Shape&, const Pose&);

}  // namespace broadmark::scenes
