#include "broadmark/scenes/settings.h"

#include <algorithm>
#include <cmath>

#include "broadmark/scenes/registry.h"
#include "broadmark/scenes/simulation.h"
#include "entries.h"

namespace broadmark::scenes {
namespace {

// Groups of parameters.
constexpr std::string_view kStart = "Bodies at the start";
constexpr std::string_view kForces = "Forces and contacts";
constexpr std::string_view kSolver = "Solver";

}  // namespace

void PhysicsSettings::visit(const ParameterVisitor& visit) {
  visit({"time_step", "time between frames, in seconds", &time_step, 1e-4, 1, kSolver});
  visit({"substeps", "physics steps per frame", &substeps, 1, 1000, kSolver});
  visit({"solver_iterations", "iterations of the contact solver per physics step",
         &solver_iterations, 1, 1000, kSolver});
  visit({"friction", "Coulomb friction of contacts", &friction, 0, 10, kForces});
  visit({"restitution", "restitution of contacts (1: fully elastic)", &restitution, 0, 1, kForces});
  visit({"linear_damping", "share of its velocity that a body loses per second", &linear_damping, 0,
         1, kForces});
  visit({"angular_damping", "share of its angular velocity that a body loses per second",
         &angular_damping, 0, 1, kForces});
  visit({"max_angular_speed", "largest angular speed, in radians per second", &max_angular_speed, 0,
         1000, kForces});
  visit({"sleep_threshold", "kinetic energy per mass below which a body may fall asleep",
         &sleep_threshold, 0, 1e6, kSolver});
}

Settings::Settings() : object_type(choiceOf(objectTypes())), engine(choiceOf(engineEntries())) {}

void Settings::visit(const ParameterVisitor& visit) {
  visit({"objects", "number of bodies", &objects, 0, kMaxBodies});
  visit({"frames", "number of frames after the initial pose", &frames, 1, kMaxFrames});
  visit({"object_type", "shape of the bodies", &object_type});
  visit({"engine", "physics engine that moves the bodies", &engine});
  visit({"seed", "seed of the random numbers", &seed, 0, 4'294'967'295});
  visit({"density",
         "share of the world's volume that bodies fill, each counted as a cube with edge 'scale'",
         &density, 1e-6, 1, kStart});
  visit({"scale", "factor on the size of all bodies, in world units", &scale, 1e-3, 1e3, kStart});
  visit({"mass", "mass of a body", &mass, 1e-3, 1e6, kStart});
  visit({"initial_radius", "radius of the ball in which bodies start, in sides of the world",
         &initial_radius, 0, 1, kStart});
  visit({"initial_speed", "largest speed of a launched body, in sides of the world per second",
         &initial_speed, 0, 10, kStart});
  visit({"gravity", "gravity, in sides of the world per second squared", &gravity, 0, 10, kForces});
  physics.visit(visit);
}

double Settings::side() const {
  // An empty world is as large as a world of one body.
  const auto bodies = static_cast<double>(std::max<std::int64_t>(objects, 1));
  return std::cbrt(bodies * scale * scale * scale / density);
}

Aabb Settings::world() const {
  const auto half = static_cast<float>(side() / 2);
  return {{-half, -half, -half, 0}, {half, half, half, 0}};
}

}  // namespace broadmark::scenes
