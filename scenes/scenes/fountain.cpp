// Fountain: a nozzle in the floor throws bodies up; they fall, come to rest and vanish. The jet
// swells and subsides, and so the number of bodies rises and falls. A new body reuses the id of a
// body that has vanished, often in the same frame. A body that has fallen back to the
// floor changes to a layer of its own, which does not collide with bodies in the air.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "broadmark/scenes/scene.h"
#include "entries.h"
#include "scenes/course.h"
#include "scenes/lifetimes.h"

namespace broadmark::scenes::fountain {
namespace {

enum Layer : std::uint8_t { air, pool };

class Fountain final : public Scene {
 public:
  void setDefaults(Settings& settings) const override {
    settings.density = 0.02;
    settings.initial_radius = 0.1;
    settings.initial_speed = 1.1;
    settings.gravity = 0.8;
  }

  void visitParameters(const ParameterVisitor& visit) override {
    visit({"lifetime", "frames after which a body vanishes, on average", &lifetime_, 1, 1'000'000});
    visit({"period", "frames from one swell of the jet to the next", &period_, 1, 1'000'000});
    visit({"spread", "largest sideways speed of the jet, as a share of the upward one", &spread_, 0,
           1});
    visit({"filled", "share of the bodies present at the start, anywhere in the world", &filled_, 0,
           1});
    visit({"pool", "whether bodies that have fallen to the floor collide only with each other",
           &pool_});
  }

  void describe(const Settings&, SceneInfo& info) const override {
    info.all_present = false;
    if (!pool_) return;
    info.filter_changes = true;
    info.filter = {std::vector<BodyGroups>(info.objects),
                   LayerMatrix().set(air, air).set(pool, pool), true};
  }

  void prepare(const Settings& settings, Random&) override {
    lifetimes_.reset(0, static_cast<std::size_t>(settings.objects));
    due_ = 0;
  }

  void populate(Stage& stage) override {
    const auto count = static_cast<std::size_t>(filled_ * static_cast<double>(stage.bodies.size()));
    for (std::size_t i = 0; i < count; ++i) {
      const auto id = lifetimes_.allocate(framesOf(stage.random.uniform()));
      stage.bodies.add(*id, stage.describeAnywhere(*id));
    }
  }

  void act(Stage& stage, std::uint32_t frame) override {
    lifetimes_.removeOld(stage.bodies, frame);
    if (pool_) changeLayers(stage);
    const double phase = 2 * std::numbers::pi * frame / static_cast<double>(period_);
    due_ += (1 - std::cos(phase)) / 2 * static_cast<double>(stage.bodies.size()) /
            static_cast<double>(lifetime_);
    for (; due_ >= 1; --due_) {
      const auto id = lifetimes_.allocate(frame + framesOf(stage.random.between(0.5, 1.5)));
      if (!id) continue;
      stage.bodies.add(*id, thrown(*id, stage));
      if (pool_) stage.bodies.setLayer(*id, Layer::air);
    }
  }

 private:
  static void changeLayers(Stage& stage) {
    const double floor = -0.5 * stage.settings.side();
    const double surface = floor + 0.25 * stage.settings.scale;
    for (const std::uint32_t id : stage.bodies.inEngine()) {
      const PhysicsBody* const body = stage.bodies[id];
      if (body == nullptr || body->linearVelocity()[1] > 0) continue;
      if (stage.bodies.boxes()[id].min[1] <= surface) stage.bodies.setLayer(id, Layer::pool);
    }
  }

  /// The duration in frames; at least one.
  [[nodiscard]] std::uint32_t framesOf(double lifetimes) const {
    return 1 + static_cast<std::uint32_t>(lifetimes * static_cast<double>(lifetime_));
  }

  [[nodiscard]] BodyDescription thrown(std::size_t id, Stage& stage) const {
    const Settings& settings = stage.settings;
    const double side = settings.side();
    BodyDescription body = stage.describeBody(id);
    const float reach = farthestInside(body.shape, side);
    const Vec3 nozzle_point =
        stage.random.inBall(std::min<double>(settings.initial_radius * side, reach));
    body.pose.position = {nozzle_point[0], -reach, nozzle_point[2]};
    const double speed = settings.initial_speed * side * stage.random.between(0.7, 1);
    const Vec3 sideways = stage.random.inBall(spread_ * speed);
    body.linear_velocity = {sideways[0], static_cast<float>(speed), sideways[2]};
    return body;
  }

  std::int64_t lifetime_ = 150;
  std::int64_t period_ = 400;
  double spread_ = 0.2;
  double filled_ = 0.25;
  bool pool_ = true;
  Lifetimes lifetimes_;
  double due_ = 0;  ///< bodies to throw, including a fraction
};

}  // namespace

SceneEntry entry() {
  return {{"fountain", "Fountain", "bodies are thrown up, fall and vanish: ids are reused"},
          makeEntry<Scene, Fountain>};
}

}  // namespace broadmark::scenes::fountain
