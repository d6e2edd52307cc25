// Brownian: no gravity; in every frame the next few bodies get a new random velocity. Bodies stay
// spread over the whole world and never rest.

#include <cmath>

#include "broadmark/scenes/scene.h"
#include "entries.h"

namespace broadmark::scenes::brownian {
namespace {

class Brownian final : public Scene {
 public:
  void setDefaults(Settings& settings) const override { settings.gravity = 0; }

  void visitParameters(const ParameterVisitor& visit) override {
    visit({"launch_share", "share of the bodies that get a new velocity in each frame",
           &launch_share_, 0, 1});
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
