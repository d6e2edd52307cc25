// Gravity: a strong gravity that keeps changing direction. All bodies move together and pile up on
// one wall after another.

#include "scenes/gravity.h"

#include <Eigen/Geometry>
#include <numbers>

#include "broadmark/scenes/scene.h"
#include "entries.h"

namespace broadmark::scenes {
namespace {

Vec3 turnedAbout(const Vec3& axis, double angle, const Vec3& vector) {
  const Eigen::AngleAxisf rotation(static_cast<float>(angle), Eigen::Vector3f(axis.data()));
  // Normalised, because rounding errors would accumulate over thousands of turns.
  const Eigen::Vector3f turned = (rotation * Eigen::Vector3f(vector.data())).normalized();
  return {turned.x(), turned.y(), turned.z()};
}

}  // namespace

TurningDirection turned(const TurningDirection& from, double angle) {
  TurningDirection to;
  to.axis = turnedAbout({0, 0, 1}, angle, from.axis);
  to.direction = turnedAbout(to.axis, angle, from.direction);
  return to;
}

namespace gravity {
namespace {

class Gravity final : public Scene {
 public:
  void visitParameters(const ParameterVisitor& visit) override {
    visit({"strength", "factor on gravity", &strength_, 0, 1000});
    visit({"period", "time of one full turn, in seconds", &period_, 1e-3, 1e6});
  }

  void start(Stage& stage) override {
    turning_ = {};
    apply(stage);
  }

  void act(Stage& stage, std::uint32_t) override {
    const double angle = 2 * std::numbers::pi * stage.settings.physics.time_step / period_;
    turning_ = turned(turning_, angle);
    apply(stage);
  }

 private:
  void apply(Stage& stage) const {
    const Settings& settings = stage.settings;
    const auto force = static_cast<float>(strength_ * settings.gravity * settings.side());
    const Vec3& towards = turning_.direction;
    stage.engine.setGravity({force * towards[0], force * towards[1], force * towards[2]});
  }

  double strength_ = 4;
  double period_ = 6.2;
  TurningDirection turning_;
};

}  // namespace

SceneEntry entry() {
  return {{"gravity", "Gravity", "strong gravity that keeps changing direction"},
          makeEntry<Scene, Gravity>};
}

}  // namespace gravity
}  // namespace broadmark::scenes
