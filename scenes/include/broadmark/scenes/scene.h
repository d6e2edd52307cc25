// A scene: which bodies there are, which forces act, and what happens in each frame.
#pragma once

#include <cstdint>
#include <span>

#include "broadmark/parameters.h"
#include "broadmark/scenes/random.h"
#include "broadmark/scenes/registry.h"
#include "scenes/settings.h"

namespace broadmark::scenes {

/// What a scene acts on, lent for a call.
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
  /// Changes defaults of the shared parameters that do not suit this scene.
  virtual void setDefaults(Settings&) const {}

  /// Called before the first body is asked for: what concerns all of them is decided here.
  virtual void prepare(const Settings&, Random&) {}

  /// Body `index` as it starts. By default: uniformly in a ball around the origin, unturned, with a
  /// random velocity. Called once for each body, in order.
  virtual BodyDescription body(std::size_t index, const Settings&, const ObjectType&, Random&);

  /// Called when all bodies stand in their initial pose. By default gravity points down.
  virtual void start(Stage& stage);

  /// Called after frame `frame` has been recorded.
  virtual void act(Stage&, std::uint32_t /*frame*/) {}
};

/// A random launch velocity: uniform in a ball, in proportion to the world's side.
Vec3 launchVelocity(const Settings&, Random&);

}  // namespace broadmark::scenes
