// Painting: the bodies that a brush places, where there is room.

#include "broadmark/scenes/brush.h"

#include <fmt/format.h>

#include <algorithm>
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

TakenRoom::TakenRoom(std::span<const AuthoredBody> bodies) : boxes_(std::make_unique<Occupied>()) {
  for (const AuthoredBody& body : bodies) add(body);
}
TakenRoom::~TakenRoom() = default;
TakenRoom::TakenRoom(TakenRoom&&) noexcept = default;
TakenRoom& TakenRoom::operator=(TakenRoom&&) noexcept = default;

void TakenRoom::add(const AuthoredBody& body) {
  boxes_->add(core(tightBox(body.shape, body.pose)));
}

bool TakenRoom::overlaps(const AuthoredBody& body) const {
  return boxes_->overlaps(core(tightBox(body.shape, body.pose)));
}

Stroke paint(const Brush& brush, const Paint& paint, const Vec3& at, const TakenRoom& taken,
             std::size_t most) {
  Random random(static_cast<std::uint64_t>(paint.seed));
  const ObjectType type = entryOf(objectTypes(), paint.object_type.value, "object type");
  const std::size_t count = checkedCount(brush.count(paint.scale * paint.scale * paint.scale));
  TakenRoom own;
  Stroke stroke;
  const int tries = brush.scatters() && !paint.overlap ? kTries : 1;
  for (std::size_t i = 0; i < std::min(count, most); ++i) {
    AuthoredBody body;
    body.shape = type.shape(i, paint.scale, random);
    body.mass = paint.mass;
    body.frozen = paint.frozen;
    bool placed = false;
    for (int attempt = 0; attempt < tries && !placed; ++attempt) {
      const Vec3 place = brush.place(i, random);
      for (std::size_t axis = 0; axis < 3; ++axis)
        body.pose.position[axis] = at[axis] + place[axis];
      if (!paint.overlap && (taken.overlaps(body) || own.overlaps(body))) continue;
      placed = true;
      if (!paint.overlap) own.add(body);
      stroke.bodies.push_back(body);
    }
    stroke.left_out += placed ? 0 : 1;
  }
  return stroke;
}

Stroke paint(const Brush& brush, const Paint& paint, const Vec3& at,
             std::span<const AuthoredBody> present) {
  return scenes::paint(brush, paint, at,
                       TakenRoom(paint.overlap ? std::span<const AuthoredBody>() : present));
}

}  // namespace broadmark::scenes
