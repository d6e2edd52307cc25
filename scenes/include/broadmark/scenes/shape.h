// Shapes of bodies, and the tight boxes around them.
#pragma once

#include <variant>

#include "broadmark/pose.h"

namespace broadmark::scenes {

struct BoxShape {
  Vec3 half_extents{};

  friend bool operator==(const BoxShape&, const BoxShape&) = default;
};

struct SphereShape {
  float radius = 0;

  friend bool operator==(const SphereShape&, const SphereShape&) = default;
};

/// The shape of a body around its centre.
using Shape = std::variant<BoxShape, SphereShape>;

/// The edges of a box along its own axes; three times the diameter of a sphere.
Vec3 edgesOf(const Shape&);

/// The smallest axis-aligned box around the posed shape, with no margin: a rotated box extends
/// |R|·half extents from its centre, a sphere its radius.
Aabb tightBox(const Shape&, const Pose&);

}  // namespace broadmark::scenes
