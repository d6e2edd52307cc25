// Painting: the bodies that a brush places, where there is room.

#include "broadmark/scenes/brush.h"

#include <fmt/format.h>

#include <cmath>

#include "broadmark/error.h"
#include "broadmark/scenes/registry.h"
#include "broadmark/scenes/simulation.h"
#include "brushes/occupied.h"
#include "entries.h"

namespace broadmark::scenes {
namespace {

/// Share of its size by which a box may reach into another: bodies that touch, after rounding.
constexpr float kTouch = 1e-4F;
/// Places that a brush that scatters tries for each body.
constexpr int kTries = 100;

/// The box without a skin of that thickness.
Aabb core(Aabb box) {
  for (int axis = 0; axis < 3; ++axis) {
    const float skin = kTouch * (box.max[axis] - box.min[axis]);
    box.min[axis] += skin;
    box.max[axis] -= skin;
  }
  return box;
}

std::size_t checkedCount(double count) {
  const double whole = std::floor(count);
  if (whole >= 0 && whole <= static_cast<double>(kMostBodies)) {
    return static_cast<std::size_t>(whole);
  }
  throw InputError(fmt::format("the brush would place {:.4g} bodies: a scene has at most {}", whole,
                               kMostBodies));
}

}  // namespace

Paint::Paint() : object_type(choiceOf(objectTypes())) {}

void Paint::visitParameters(const ParameterVisitor& visit) {
  visit({"object_type", "what the bodies are", &object_type});
  visit({"scale", "factor on the size of the bodies, in world units", &scale, 1e-3, 1e3});
  visit({"mass", "mass of a body", &mass, 1e-3, 1e6});
  visit({"frozen", "whether they are immovable obstacles", &frozen});
  visit({"overlap", "whether they may overlap each other and other bodies", &overlap});
  visit({"seed", "start of the random numbers", &seed, 0, 4'294'967'295});
}

Stroke paint(const Brush& brush, const Paint& paint, const Vec3& at,
             std::span<const AuthoredBody> present) {
  Random random(static_cast<std::uint64_t>(paint.seed));
  const ObjectType type = entryOf(objectTypes(), paint.object_type.value, "object type");
  const std::size_t count = checkedCount(brush.count(paint.scale * paint.scale * paint.scale));
  Occupied occupied;
  if (!paint.overlap) {
    for (const AuthoredBody& body : present) occupied.add(core(tightBox(body.shape, body.pose)));
  }
  Stroke stroke;
  const int tries = brush.scatters() && !paint.overlap ? kTries : 1;
  for (std::size_t i = 0; i < count; ++i) {
    AuthoredBody body;
    body.shape = type.shape(i, paint.scale, random);
    body.mass = paint.mass;
    body.frozen = paint.frozen;
    bool placed = false;
    for (int attempt = 0; attempt < tries && !placed; ++attempt) {
      const Vec3 place = brush.place(i, random);
      for (std::size_t axis = 0; axis < 3; ++axis)
        body.pose.position[axis] = at[axis] + place[axis];
      const Aabb box = core(tightBox(body.shape, body.pose));
      if (!paint.overlap && occupied.overlaps(box)) continue;
      placed = true;
      if (!paint.overlap) occupied.add(box);
      stroke.bodies.push_back(body);
    }
    stroke.left_out += placed ? 0 : 1;
  }
  return stroke;
}

}  // namespace broadmark::scenes
