// Swarm: flocks that gather, wander about, turn at the walls and collide: moving clusters in an
// otherwise empty world. Made for the boids engine; with other engines the flocks fly apart.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "broadmark/scenes/scene.h"
#include "entries.h"

namespace broadmark::scenes::swarm {
namespace {

Vec3 sum(const Vec3& a, const Vec3& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }

Vec3 inDirection(const Vec3& direction, double length) {
  const double norm = std::hypot(direction[0], direction[1], direction[2]);
  const auto factor = static_cast<float>(norm > 0 ? length / norm : 0);
  return {factor * direction[0], factor * direction[1], factor * direction[2]};
}

class Swarm final : public Scene {
 public:
  void setDefaults(Settings& settings) const override {
    settings.engine.value = "boids";
    settings.density = 0.003;
    settings.initial_radius = 0.09;
    settings.initial_speed = 0.2;
    settings.gravity = 0;
    settings.physics.substeps = 1;
  }

  void visitParameters(const ParameterVisitor& visit) override {
    visit({"flocks", "number of flocks at the start, each in a ball of the initial radius",
           &flocks_, 1, 1'000'000});
    visit({"disorder", "spread of velocities within a flock at the start, per initial speed",
           &disorder_, 0, 1});
  }

  void prepare(const Settings& settings, Random& random) override {
    starts_.resize(static_cast<std::size_t>(std::min(flocks_, settings.objects)));
    const double limit = std::max(0.0, 0.5 - settings.initial_radius) * settings.side();
    for (Start& start : starts_) {
      start.centre = random.inBall(limit);
      start.velocity = inDirection(random.inBall(1), settings.initial_speed * settings.side());
    }
  }

  void place(std::size_t index, BodyDescription& body, const Settings& settings,
             Random& random) override {
    const Start& start = starts_[index % starts_.size()];
    body.pose.position =
        sum(start.centre, random.inBall(settings.initial_radius * settings.side()));
    body.linear_velocity =
        sum(start.velocity, random.inBall(disorder_ * settings.initial_speed * settings.side()));
  }

 private:
  struct Start {
    Vec3 centre{};
    Vec3 velocity{};
  };

  std::int64_t flocks_ = 6;
  double disorder_ = 0.3;
  std::vector<Start> starts_;  ///< by flock
};

}  // namespace

SceneEntry entry() {
  return {{"swarm", "Swarm", "flocks of boids wander about"}, makeEntry<Scene, Swarm>};
}

}  // namespace broadmark::scenes::swarm
