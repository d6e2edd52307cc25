// Brownian: no gravity, and in every frame some bodies get a new random velocity, in turn. Bodies
// stay spread over the whole world and never rest.

#include <cmath>

#include "scenes/scene.h"

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
  std::size_t next_ = 0;  ///< whose turn it is
};

}  // namespace

SceneEntry entry() {
  return {.listing = {"brownian", "Brownian", "bodies fly about without gravity, pushed at random"},
          .create = []() -> std::unique_ptr<Scene> { return std::make_unique<Brownian>(); }};
}

}  // namespace broadmark::scenes::brownian
