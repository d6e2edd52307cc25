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

/// Parameters of motion and collisions; the same for all bodies of a world.
struct PhysicsSettings {
  double time_step = 1.0 / 30;  ///< seconds per step()
  std::int64_t substeps = 4;
  std::int64_t solver_iterations = 6;
  double friction = 0.6;      ///< Coulomb coefficient of every contact
  double restitution = 0;     ///< of every contact
  double linear_damping = 0;  ///< fraction of velocity lost per second
  double angular_damping = 0.05;
  double max_angular_speed = 7;    ///< radians per second
  double sleep_threshold = 0.005;  ///< kinetic energy per mass below which a body may fall asleep

  void visit(const ParameterVisitor&);
};

/// A body to be created.
struct BodyDescription {
  Shape shape;
  double mass = 1;
  Pose pose;
  Vec3 linear_velocity{};   ///< world units per second
  Vec3 angular_velocity{};  ///< radians per second
  std::uint8_t layer = 0;   ///< see setLayers()
  std::uint32_t world = 0;  ///< bodies of different worlds never collide
};

/// A wall, on one side of a plane: normal · point >= offset.
struct HalfSpace {
  Vec3 normal{};  ///< unit length, towards the free side
  float offset = 0;
};

/// A body, owned by a PhysicsEngine.
class PhysicsBody {
 public:
  virtual ~PhysicsBody() = default;

  [[nodiscard]] virtual const Shape& shape() const = 0;
  [[nodiscard]] virtual Pose pose() const = 0;
  [[nodiscard]] virtual Vec3 linearVelocity() const = 0;
  [[nodiscard]] virtual Vec3 angularVelocity() const = 0;

  /// Sets the pose and wakes the body.
  virtual void setPose(const Pose&) = 0;
  /// Sets the velocities and wakes the body. No effect on a frozen body.
  virtual void setVelocity(const Vec3& linear, const Vec3& angular) = 0;

  /// Whether the body rests until something touches it. A frozen body counts as asleep.
  [[nodiscard]] virtual bool asleep() const = 0;
  [[nodiscard]] virtual bool frozen() const = 0;
  /// Makes the body an immovable obstacle from now on.
  virtual void freeze() = 0;
};

/// A world of bodies. Deterministic: the same calls yield the same bits. Instances are independent.
/// Visits only the parameters of this engine; their names must differ from those of the
/// settings and of every scene.
class PhysicsEngine : public Parametrised {
 public:
  /// Sets the layers that push each other; by default all. Walls hold bodies of every layer. Must
  /// be called before bodies are added.
  virtual void setLayers(const LayerMatrix&) = 0;
  /// Adds a body. The reference stays valid until the body is removed.
  virtual PhysicsBody& addBody(const BodyDescription&) = 0;
  /// Removes a body of this engine, and wakes the bodies touching it.
  virtual void removeBody(PhysicsBody&) = 0;
  virtual void addWall(const HalfSpace&) = 0;
  /// Acceleration of all bodies. A change wakes them.
  virtual void setGravity(const Vec3&) = 0;
  [[nodiscard]] virtual Vec3 gravity() const = 0;

  /// Advances by one time step.
  virtual void step() = 0;
  [[nodiscard]] virtual bool allAsleep() const = 0;
};

}  // namespace broadmark::scenes
