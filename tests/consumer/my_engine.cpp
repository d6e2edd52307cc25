// A custom physics engine, as a library that Broadmark loads: bodies drift and bounce off the
// walls.

#include <broadmark/scenes/body_pool.h>
#include <broadmark/scenes/engine_plugin.h>

#include <memory>
#include <vector>

namespace {

using broadmark::Pose;
using broadmark::Vec3;
using namespace broadmark::scenes;

class DriftingBody : public PhysicsBody {
 public:
  explicit DriftingBody(const BodyDescription& body)
      : shape_(body.shape), pose_(body.pose), velocity_(body.linear_velocity) {}

  const Shape& shape() const override { return shape_; }
  Pose pose() const override { return pose_; }
  Vec3 linearVelocity() const override { return velocity_; }
  Vec3 angularVelocity() const override { return {}; }
  void setPose(const Pose& pose) override { pose_ = pose; }
  void setVelocity(const Vec3& linear, const Vec3&) override {
    if (!frozen_) velocity_ = linear;
  }
  bool asleep() const override { return frozen_; }
  bool frozen() const override { return frozen_; }
  void freeze() override {
    frozen_ = true;
    velocity_ = {};
  }

  /// Advances by `time`.
  void drift(float time, const std::vector<HalfSpace>& walls) {
    for (std::size_t axis = 0; axis < 3; ++axis) pose_.position[axis] += time * velocity_[axis];
    for (const HalfSpace& wall : walls) turnBack(wall);
  }

 private:
  /// Bounces off a wall if its centre is behind it. Walls are perpendicular to an axis.
  void turnBack(const HalfSpace& wall) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float side = wall.normal[axis];
      if (side * pose_.position[axis] >= wall.offset || side == 0) continue;
      pose_.position[axis] = side * wall.offset;
      if (side * velocity_[axis] < 0) velocity_[axis] = -velocity_[axis];
    }
  }

  Shape shape_;
  Pose pose_;
  Vec3 velocity_;
  bool frozen_ = false;
};

class DriftingEngine final : public PhysicsEngine {
 public:
  explicit DriftingEngine(const PhysicsSettings& settings)
      : time_(static_cast<float>(settings.time_step)) {}

  void visitParameters(const broadmark::ParameterVisitor& visit) override {
    visit({"drift", "factor on the speed of all bodies", &drift_, 0, 100});
  }

  void setLayers(const broadmark::LayerMatrix&) override {}
  PhysicsBody& addBody(const BodyDescription& body) override { return bodies_.add(body); }
  void removeBody(PhysicsBody& body) override { bodies_.remove(static_cast<DriftingBody&>(body)); }
  void addWall(const HalfSpace& wall) override { walls_.push_back(wall); }
  void setGravity(const Vec3& gravity) override { gravity_ = gravity; }
  Vec3 gravity() const override { return gravity_; }
  void step() override {
    const float time = time_ * static_cast<float>(drift_);
    bodies_.each([&](DriftingBody& body) { body.drift(time, walls_); });
  }
  bool allAsleep() const override {
    return bodies_.all([](const DriftingBody& body) { return body.asleep(); });
  }

 private:
  float time_;  ///< per step
  double drift_ = 1;
  Vec3 gravity_{};
  std::vector<HalfSpace> walls_;
  BodyPool<DriftingBody> bodies_;
};

std::vector<EngineEntry> engines() {
  return {{.listing = {.id = "drift",
                       .summary = "bodies drift about, for an example",
                       .dynamics = broadmark::Dynamics::scripted},
           .create = [](const PhysicsSettings& settings) -> std::unique_ptr<PhysicsEngine> {
             return std::make_unique<DriftingEngine>(settings);
           }}};
}

}  // namespace

BROADMARK_ENGINE_PLUGIN(engines);
