// Shapes of bodies, and the tight boxes around them.
//
// Example:
//
//   const scenes::Shape crate = scenes::BoxShape{{0.5F, 0.5F, 1}};
//   const Vec3 edges = scenes::edgesOf(crate);                           // 1, 1, 2
//   const Aabb box = scenes::tightBox(crate, {.position = {0, 0, 3}});   // z from 2 to 4
//   const Aabb ball = scenes::tightBox(scenes::SphereShape{2}, Pose());  // -2 to 2 on each axis
#pragma once

#include <variant>

#include "broadmark/pose.h"

namespace broadmark::scenes {

/// A box centred at the body's position, with its edges along the body's axes.
struct BoxShape {
  Vec3 half_extents{};  ///< half the edges, in world units

  friend bool operator==(const BoxShape&, const BoxShape&) = default;
};

/// A sphere centred at the body's position.
struct SphereShape {
  float radius = 0;  ///< world units

  friend bool operator==(const SphereShape&, const SphereShape&) = default;
};

/// The shape of a body around its centre.
using Shape = std::variant<BoxShape, SphereShape>;

/// The edges of a box along its own axes; of a sphere the diameter, three times.
Vec3 edgesOf(const Shape&);

/// The smallest axis-aligned box around the posed shape, with no margin: a rotated box extends
/// |R|·half extents from its centre, a sphere its radius. In 32-bit floats: corners are rounded to
/// nearest, not outward.
Aabb tightBox(const Shape&, const Pose&);

}  // namespace broadmark::scenes
