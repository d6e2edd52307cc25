// Spot: all bodies at one point, then flying apart. At first every body overlaps every other, and
// nothing moves; then they fly off in all directions, and soon hardly any two overlap.

#include <cstdint>

#include "broadmark/scenes/scene.h"
#include "broadmark/scenes/simulation.h"
#include "entries.h"

namespace broadmark::scenes::spot {
namespace {

class Spot final : public Scene {
 public:
  void setDefaults(Settings& settings) const override {
    setFreeFlight(settings);
    settings.density = 0.02;
    settings.initial_speed = 0.5;
  }

  void visitParameters(const ParameterVisitor& visit) override {
    visit({"hold", "frame after which the bodies fly apart", &hold_, 1, kMaxFrames});
  }

  /// Physics would try to separate all bodies from each other.
  [[nodiscard]] LayerMatrix pushing(const SceneInfo&) const override { return {}; }

  void prepare(const Settings& settings, Random& random) override {
    spot_ = random.inBall(settings.initial_radius * settings.side() / 2);
  }

  void place(std::size_t, BodyDescription& body, const Settings&, Random&) override {
    body.pose.position = spot_;
  }

  void act(Stage& stage, std::uint32_t frame) override {
    if (frame != hold_) return;
    for (const std::uint32_t id : stage.bodies.inEngine()) {
      stage.bodies[id]->setVelocity(launchVelocity(stage.settings, stage.random), {});
    }
  }

 private:
  std::int64_t hold_ = 5;
  Vec3 spot_{};
};

}  // namespace

SceneEntry entry() {
  return {{"spot", "Spot", "all bodies at one place, then apart"}, makeEntry<Scene, Spot>};
}

}  // namespace broadmark::scenes::spot
