// The interface of a physics engine. One implementation per file, listed in CMakeLists.txt.
//
// Example:
//
//   const auto drop = [](scenes::PhysicsEngine& engine, const scenes::Shape& shape) {
//     engine.setGravity({0, 0, -9.81F});
//     engine.addWall({.normal = {0, 0, 1}, .offset = 0});
//     const scenes::PhysicsBody& body = engine.addBody({.shape = shape, .mass = 2});
//     while (!engine.allAsleep()) engine.step();
//     return body.pose();
//   };
#pragma once

#include <cstdint>

#include "broadmark/collision_filter.h"
#include "broadmark/parameters.h"
#include "broadmark/scenes/shape.h"

namespace broadmark::scenes {

/// Parameters of motion and collisions; the same for all bodies of a world. visit() states their
/// ranges. An engine may ignore those that do not apply to it: boids use only the time step.
struct PhysicsSettings {
  double time_step = 1.0 / 30;         ///< seconds per step()
  std::int64_t substeps = 4;           ///< of equal duration, per step()
  std::int64_t solver_iterations = 6;  ///< per substep
  double friction = 0.6;               ///< Coulomb coefficient of every contact
  double restitution = 0;              ///< of every contact; 1: elastic
  double linear_damping = 0;           ///< fraction of velocity lost per second
  double angular_damping = 0.05;       ///< fraction of angular velocity lost per second
  double max_angular_speed = 7;        ///< radians per second
  double sleep_threshold = 0.005;  ///< kinetic energy per mass below which a body may fall asleep

  /// Visits each parameter with its range, as Parametrised::visitParameters().
  void visit(const ParameterVisitor&);
};

/// A body to be created.
struct BodyDescription {
  Shape shape;
  double mass = 1;          ///< above 0, in any unit; kinematic and boids ignore it
  Pose pose;                ///< initial pose, in world units
  Vec3 linear_velocity{};   ///< world units per second
  Vec3 angular_velocity{};  ///< radians per second
  std::uint8_t layer = 0;   ///< below LayerMatrix::kLayers, see setLayers()
  /// In a simulation, bodies of different worlds never collide: it makes an engine for each world.
  /// The engines themselves ignore the world.
  std::uint32_t world = 0;
};

/// A wall, on one side of a plane: normal · point >= offset.
struct HalfSpace {
  Vec3 normal{};  ///< unit length, towards the free side
  float offset = 0;
};

/// A body, owned by a PhysicsEngine. Valid until it is removed, or the engine is destroyed.
class PhysicsBody {
 public:
  virtual ~PhysicsBody() = default;

  /// As in its description.
  [[nodiscard]] virtual const Shape& shape() const = 0;
  /// After the last step(), or as set since.
  [[nodiscard]] virtual Pose pose() const = 0;
  /// World units per second.
  [[nodiscard]] virtual Vec3 linearVelocity() const = 0;
  /// Radians per second; 0 for boids.
  [[nodiscard]] virtual Vec3 angularVelocity() const = 0;

  /// Sets the pose and wakes the body, unless it is frozen. A boid without speed sleeps on.
  virtual void setPose(const Pose&) = 0;
  /// Sets the velocities and wakes the body. No effect on a frozen body. A boid keeps about this
  /// speed from then on; with speed 0 it falls asleep.
  virtual void setVelocity(const Vec3& linear, const Vec3& angular) = 0;

  /// Whether the body rests until something touches it. A frozen body counts as asleep.
  [[nodiscard]] virtual bool asleep() const = 0;
  [[nodiscard]] virtual bool frozen() const = 0;
  /// Makes the body an immovable obstacle, without velocities, from now on. Irreversible.
  virtual void freeze() = 0;
};

/// A world of bodies. Deterministic: the same calls yield the same bits. Instances are independent,
/// so each may be used by its own thread. Created by EngineEntry::create() (registry.h). Visits
/// only the parameters of this engine; their names must differ from those of the settings and of
/// every scene.
class PhysicsEngine : public Parametrised {
 public:
  /// Sets the layers that push each other; by default all. Walls hold bodies of every layer. Must
  /// be called before bodies are added.
  virtual void setLayers(const LayerMatrix&) = 0;
  /// Adds a body. The engine owns it; the reference stays valid until the body is removed.
  virtual PhysicsBody& addBody(const BodyDescription&) = 0;
  /// Removes and destroys a body of this engine, and wakes the bodies touching it, if they collide.
  virtual void removeBody(PhysicsBody&) = 0;
  /// Adds an immovable wall for the life of the engine.
  virtual void addWall(const HalfSpace&) = 0;
  /// Acceleration of all bodies, in world units per second squared; 0 at first. A change wakes
  /// them, except boids.
  virtual void setGravity(const Vec3&) = 0;
  [[nodiscard]] virtual Vec3 gravity() const = 0;

  /// Advances by PhysicsSettings::time_step.
  virtual void step() = 0;
  /// Whether steps may be omitted until a body is added, removed, set or woken; true without
  /// bodies. Possibly before every body is asleep(). O(n).
  [[nodiscard]] virtual bool allAsleep() const = 0;
};

}  // namespace broadmark::scenes
