// The interface of a scene: its bodies, its forces, and its actions in each frame.
#pragma once

#include <cstddef>
#include <cstdint>

#include "broadmark/parameters.h"
#include "broadmark/scenes/bodies.h"
#include "broadmark/scenes/physics_engine.h"
#include "broadmark/scenes/random.h"
#include "broadmark/scenes/registry.h"
#include "broadmark/scenes/settings.h"

namespace broadmark::scenes {

/// The objects that a scene acts on. Valid only during the call.
struct Stage {
  const Settings& settings;
  const ObjectType& object_type;
  PhysicsEngine& engine;
  Bodies& bodies;
  Random& random;

  /// Body `id`, at rest at the origin, of `size` times the usual size.
  [[nodiscard]] BodyDescription describeBody(std::size_t id, double size = 1) const;
  /// The same at a random position, inside the world in any rotation.
  [[nodiscard]] BodyDescription describeAnywhere(std::size_t id, double size = 1) const;
};

/// A scene. One implementation per file, listed in CMakeLists.txt. Visits only the parameters of
/// this scene.
class Scene : public Parametrised {
 public:
  /// Adapts the defaults of shared parameters to this scene.
  virtual void setDefaults(Settings&) const {}

  /// Sets the scene's special properties: absent bodies, unwanted pairs, another world. Called
  /// whenever the parameters may have changed.
  virtual void describe(const Settings&, SceneInfo&) const {}

  /// The layers that push each other. By default the colliding layers.
  [[nodiscard]] virtual LayerMatrix pushing(const SceneInfo& info) const {
    return info.filter.matrix();
  }

  /// Called before the first call of place(): prepares data for all bodies.
  virtual void prepare(const Settings&, Random&) {}

  /// Sets the initial pose and velocity of body `index`: by default a uniformly random position in
  /// a ball around the origin, unrotated, with a random velocity.
  virtual void place(std::size_t index, BodyDescription& body, const Settings&, Random&);

  /// Adds the bodies of the initial pose. By default all, in order, by place().
  virtual void populate(Stage& stage);

  /// Called when all bodies are in their initial pose. By default gravity points down.
  virtual void start(Stage& stage);

  /// Called after frame `frame`, 1 or later, when the next one is requested. Added bodies
  /// move before that frame is recorded.
  virtual void act(Stage&, std::uint32_t /*frame*/) {}
};

/// Defaults of bodies that fly straight on: kinematic, without gravity, bouncing elastically.
void setFreeFlight(Settings&);

/// A random initial velocity: uniform in a ball, in proportion to the world's side.
Vec3 launchVelocity(const Settings&, Random&);

}  // namespace broadmark::scenes
