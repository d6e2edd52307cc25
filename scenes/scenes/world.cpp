// World: static boxes of all sizes, up to the limit of memory, and a few bodies that fly among
// them. Two layers: static boxes do not collide with each other. The cost of a frame should depend
// on the movers only; here it does, as static boxes are scenery.

#include <algorithm>
#include <cstdint>
#include <vector>

#include "broadmark/scenes/scene.h"
#include "broadmark/scenes/simulation.h"
#include "entries.h"
#include "scenes/course.h"

namespace broadmark::scenes::world {
namespace {

class World final : public Scene {
 public:
  void setDefaults(Settings& settings) const override {
    setFreeFlight(settings);
    settings.density = 0.02;
    settings.initial_speed = 0.1;
    settings.physics.substeps = 1;
  }

  void visitParameters(const ParameterVisitor& visit) override {
    visit({"movers", "number of bodies that fly about; the others never move", &movers_, 0,
           kMaxBodies});
    visit({"largest", "longest edge of a static box, in sides of the world", &largest_, 1e-3, 1});
  }

  void describe(const Settings& settings, SceneInfo& info) const override {
    std::vector<BodyGroups> bodies(info.objects);
    for (std::size_t id = 0; id < bodies.size(); ++id) {
      bodies[id].layer = isMover(id, settings) ? 1 : 0;
    }
    info.filter = {bodies, LayerMatrix().set(0, 1).set(1, 1)};
  }

  void populate(Stage& stage) override {
    const Settings& settings = stage.settings;
    Random& random = stage.random;
    const double max_size = largest_ * settings.side() / settings.scale;
    for (std::size_t id = 0; id < stage.bodies.size(); ++id) {
      const bool mover = isMover(id, settings);
      const double size = mover ? 1 : powerLawSize(max_size, random);
      BodyDescription body = stage.describeAnywhere(id, size);
      if (mover) {
        body.linear_velocity = launchVelocity(settings, random);
        stage.bodies.add(id, body);
      } else {
        stage.bodies.place(id, body.shape, body.pose);
      }
    }
  }

 private:
  /// Movers are spread evenly over the ids.
  [[nodiscard]] bool isMover(std::size_t id, const Settings& settings) const {
    const auto count = static_cast<std::uint64_t>(settings.objects);
    const auto movers = std::min(static_cast<std::uint64_t>(movers_), count);
    return id * movers / count != (id + 1) * movers / count;
  }

  std::int64_t movers_ = 100;
  double largest_ = 0.1;
};

}  // namespace

SceneEntry entry() {
  return {{"world", "World", "static boxes of all sizes, and a few bodies that fly through them"},
          makeEntry<Scene, World>};
}

}  // namespace broadmark::scenes::world
