// The interface of a scene: which bodies there are, which forces act, what happens in each frame.
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

/// What a scene acts on. Valid during the call that it is handed to.
struct Stage {
  const Settings& settings;
  const ObjectType& object_type;
  PhysicsEngine& engine;
  Bodies& bodies;
  Random& random;

  /// Body `id`, at rest at the origin, `size` times as large as usual.
  [[nodiscard]] BodyDescription describeBody(std::size_t id, double size = 1) const;
  /// The same at a random place where it is inside the world, however it is turned.
  [[nodiscard]] BodyDescription describeAnywhere(std::size_t id, double size = 1) const;
};

/// One implementation per file, listed in CMakeLists.txt. Visits the parameters that only this
/// scene has.
class Scene : public Parametrised {
 public:
  /// Changes the defaults of shared parameters that do not suit this scene.
  virtual void setDefaults(Settings&) const {}

  /// Says what is special about the scene: bodies that are absent at times, pairs that are not
  /// wanted, another world. Called whenever the parameters may have changed.
  virtual void describe(const Settings&, SceneInfo&) const {}

  /// Which layers push each other. By default those that collide.
  [[nodiscard]] virtual LayerMatrix pushing(const SceneInfo& info) const {
    return info.filter.matrix();
  }

  /// Called before the first call of place(): decides what concerns all bodies.
  virtual void prepare(const Settings&, Random&) {}

  /// Says where body `index` starts, and with which velocity. By default at a uniformly random
  /// place in a ball around the origin, unturned, with a random velocity.
  virtual void place(std::size_t index, BodyDescription& body, const Settings&, Random&);

  /// Brings on the bodies of the initial pose. By default all, in order, as place() says.
  virtual void populate(Stage& stage);

  /// Called when all bodies are in their initial pose. By default gravity points down.
  virtual void start(Stage& stage);

  /// Called after frame `frame`, 1 or later, when the next one is asked for. Bodies that it adds
  /// move before that is recorded.
  virtual void act(Stage&, std::uint32_t /*frame*/) {}
};

/// A random initial velocity: uniform in a ball, in proportion to the world's side.
Vec3 launchVelocity(const Settings&, Random&);

}  // namespace broadmark::scenes
