// The interface of a scene: which bodies there are, which forces act, what happens in each frame.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "broadmark/parameters.h"
#include "broadmark/scenes/physics_engine.h"
#include "broadmark/scenes/random.h"
#include "broadmark/scenes/registry.h"
#include "broadmark/scenes/settings.h"

namespace broadmark::scenes {

/// What a scene acts on. Valid during the call that it is handed to.
struct Stage {
  const Settings& settings;
  PhysicsEngine& engine;
  std::span<PhysicsBody* const> bodies;  ///< all, by id
  Random& random;
};

/// One implementation per file, listed in CMakeLists.txt. Visits the parameters that only this
/// scene has.
class Scene : public Parametrised {
 public:
  /// Changes the defaults of shared parameters that do not suit this scene.
  virtual void setDefaults(Settings&) const {}

  /// Called before the first call of body(): decides what concerns all bodies.
  virtual void prepare(const Settings&, Random&) {}

  /// Body `index` as it starts. By default at a uniformly random place in a ball around the origin,
  /// unturned, with a random velocity. Called once for each body, in order.
  virtual BodyDescription body(std::size_t index, const Settings&, const ObjectType&, Random&);

  /// Called when all bodies are in their initial pose. By default gravity points down.
  virtual void start(Stage& stage);

  /// Called after frame `frame` has been recorded.
  virtual void act(Stage&, std::uint32_t /*frame*/) {}
};

/// A random initial velocity: uniform in a ball, in proportion to the world's side.
Vec3 launchVelocity(const Settings&, Random&);

}  // namespace broadmark::scenes
