// The parameters shared by all scenes.
#pragma once

#include <cstdint>

#include "broadmark/aabb.h"
#include "broadmark/parameters.h"
#include "broadmark/scenes/physics_engine.h"

namespace broadmark::scenes {

/// Lengths are in world units. The world is a cube of side (objects · scale³ / density)^(1/3), so a
/// scene has the same density at every size.
struct Settings {
  Settings();

  std::int64_t objects = 1000;
  std::int64_t frames = 1000;
  Choice object_type;
  Choice engine;
  std::int64_t seed = 1;
  double density = 0.1;
  double scale = 1;
  double mass = 1;
  double initial_radius = 0.45;  ///< of the ball of initial positions, per side
  double initial_speed = 0.75;   ///< largest, in sides per second
  double gravity = 0.0981;       ///< in sides per second squared
  PhysicsSettings physics;

  void visit(const ParameterVisitor&);
  /// Edge of the world's cube.
  [[nodiscard]] double side() const;
  /// The cube, around the origin.
  [[nodiscard]] Aabb world() const;
};

}  // namespace broadmark::scenes
