// Brownian: no gravity; in every frame the next few bodies get a new random velocity. Bodies stay
// spread over the whole world and never rest. Where they collide, collisions see to that. Where
// they pass through each other, a body slowed by a wall would wait there for its next push, and
// most would end up at the walls: there the walls are elastic, and bodies start anywhere in the
// world.

#include <algorithm>
#include <cmath>

#include "broadmark/scenes/registry.h"
#include "broadmark/scenes/scene.h"
#include "entries.h"

namespace broadmark::scenes::brownian {
namespace {

bool passEachOther(const Settings& settings) {
  const EngineEntry engine = entryOf(engineEntries(), settings.engine.value, "engine");
  return engine.listing.dynamics == Dynamics::passing;
}

class Brownian final : public Scene {
 public:
  void setDefaults(Settings& settings) const override {
    settings.gravity = 0;
    if (!passEachOther(settings)) return;
    settings.initial_radius = 1;
    settings.physics.friction = 0;
    settings.physics.restitution = 1;
  }

  void visitParameters(const ParameterVisitor& visit) override {
    visit({"launch_share", "share of the bodies that get a new velocity in each frame",
           &launch_share_, 0, 1});
  }

  /// A ball that holds the whole world: anywhere in the world.
  void place(std::size_t index, BodyDescription& body, const Settings& settings,
             Random& random) override {
    Scene::place(index, body, settings, random);
    if (settings.initial_radius * settings.initial_radius < 0.75) return;
    const Vec3 edges = edgesOf(body.shape);
    for (int axis = 0; axis < 3; ++axis) {
      const double reach = std::max(0.0, settings.side() / 2 - double{edges[axis]} / 2);
      body.pose.position[axis] = static_cast<float>(random.between(-reach, reach));
    }
  }

  void start(Stage& stage) override {
    Scene::start(stage);
    next_ = 0;
  }

  void act(Stage& stage, std::uint32_t) override {
    const auto count = static_cast<std::size_t>(
        std::ceil(launch_share_ * static_cast<double>(stage.bodies.size())));
    for (std::size_t launched = 0; launched < count; ++launched) {
      PhysicsBody& body = *stage.bodies[next_];
      body.setVelocity(launchVelocity(stage.settings, stage.random), body.angularVelocity());
      next_ = (next_ + 1) % stage.bodies.size();
    }
  }

 private:
  double launch_share_ = 0.01;
  std::size_t next_ = 0;  ///< next body to launch
};

}  // namespace

SceneEntry entry() {
  return {{"brownian", "Brownian", "bodies fly about without gravity, pushed at random"},
          makeEntry<Scene, Brownian>};
}

}  // namespace broadmark::scenes::brownian
