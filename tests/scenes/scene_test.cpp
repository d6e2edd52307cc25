// The calls of the built-in scenes to their bodies.

#include "broadmark/scenes/scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <deque>
#include <numbers>
#include <vector>

#include "entries.h"
#include "scenes/gravity.h"

namespace broadmark::scenes {
namespace {

/// A body and an engine that only record the calls.
class NotingBody final : public PhysicsBody {
 public:
  explicit NotingBody(const BodyDescription& description)
      : description_(description), linear_(description.linear_velocity) {}

  [[nodiscard]] const Shape& shape() const override { return description_.shape; }
  [[nodiscard]] Pose pose() const override { return description_.pose; }
  [[nodiscard]] Vec3 linearVelocity() const override { return linear_; }
  [[nodiscard]] Vec3 angularVelocity() const override { return angular_; }
  void setPose(const Pose& pose) override { description_.pose = pose; }
  void setVelocity(const Vec3& linear, const Vec3& angular) override {
    linear_ = linear;
    angular_ = angular;
    ++launches;
  }
  [[nodiscard]] bool asleep() const override { return false; }
  [[nodiscard]] bool frozen() const override { return frozen_; }
  void freeze() override { frozen_ = true; }

  int launches = 0;

 private:
  BodyDescription description_;
  Vec3 linear_{};
  Vec3 angular_{};
  bool frozen_ = false;
};

class NotingEngine final : public PhysicsEngine {
 public:
  PhysicsBody& addBody(const BodyDescription& description) override {
    return bodies.emplace_back(description);
  }
  void setLayers(const LayerMatrix&) override {}
  void removeBody(PhysicsBody&) override {}
  void addWall(const HalfSpace&) override {}
  void setGravity(const Vec3& value) override { noted_gravity = value; }
  [[nodiscard]] Vec3 gravity() const override { return noted_gravity; }
  void step() override {}
  [[nodiscard]] bool allAsleep() const override { return false; }

  std::deque<NotingBody> bodies;
  Vec3 noted_gravity{};
};

/// A scene of `objects` bodies on the recording engine.
struct Rehearsal {
  Rehearsal(const std::string& id, std::int64_t objects) {
    scene = entryOf(sceneEntries(), id, "scene").create();
    scene->setDefaults(settings);
    settings.objects = objects;
    bodies = Bodies(engine, {.objects = static_cast<std::uint32_t>(objects)});
    scene->populate(stage);
    scene->start(stage);
  }

  std::unique_ptr<Scene> scene;
  Settings settings;
  NotingEngine engine;
  Random random{1};
  ObjectType cubes = objectTypes().front();
  Bodies bodies{engine, {}};
  Stage stage{settings, cubes, engine, bodies, random};

  void act(std::uint32_t frame) { scene->act(stage, frame); }
};

double length(const Vec3& v) { return std::hypot(v[0], v[1], v[2]); }

TEST(Scene, BodiesStartInABallWithinTheSpeedLimit) {
  const Rehearsal freefall("freefall", 2000);
  const double side = std::cbrt(2000 / 0.1);
  double farthest = 0;
  double fastest = 0;
  for (const NotingBody& body : freefall.engine.bodies) {
    farthest = std::max(farthest, length(body.pose().position));
    fastest = std::max(fastest, length(body.linearVelocity()));
    EXPECT_EQ(body.pose().rotation, (std::array<float, 4>{0, 0, 0, 1}));
    EXPECT_EQ(std::get<BoxShape>(body.shape()).half_extents, (Vec3{0.5F, 0.5F, 0.5F}));
  }
  EXPECT_LE(farthest, 0.45 * side * (1 + 1e-6));
  EXPECT_GT(farthest, 0.45 * side * 0.99);
  EXPECT_LE(fastest, 0.75 * side * (1 + 1e-6));
  EXPECT_GT(fastest, 0.75 * side * 0.99);
}

TEST(FreeFall, GravityPointsDownInProportionToTheWorld) {
  const Rehearsal freefall("freefall", 100);
  EXPECT_EQ(freefall.engine.noted_gravity[0], 0);
  EXPECT_NEAR(freefall.engine.noted_gravity[1], -0.0981 * 10, 1e-6);
  EXPECT_EQ(freefall.engine.noted_gravity[2], 0);
}

TEST(FreeFall, FreezesSlowBodiesAfterAFrameOnlyIfAsked) {
  for (const bool asked : {false, true}) {
    Rehearsal freefall("freefall", 3);
    setParameters(*freefall.scene, {{"freeze_slow", asked ? "on" : "off"}});
    freefall.bodies[0]->setVelocity({0.4F, 0, 0}, {2.9F, 0, 0});
    freefall.bodies[1]->setVelocity({0.6F, 0, 0}, {0, 0, 0});
    freefall.bodies[2]->setVelocity({0, 0, 0}, {0, 3.1F, 0});
    freefall.act(139);
    EXPECT_FALSE(freefall.bodies[0]->frozen());
    freefall.act(140);
    EXPECT_EQ(freefall.bodies[0]->frozen(), asked);
    EXPECT_FALSE(freefall.bodies[1]->frozen()) << "too fast";
    EXPECT_FALSE(freefall.bodies[2]->frozen()) << "turns too fast";
  }
}

TEST(Brownian, LaunchesOneBodyInAHundredInTurn) {
  Rehearsal brownian("brownian", 250);
  EXPECT_EQ(length(brownian.engine.noted_gravity), 0);
  const double side = std::cbrt(250 / 0.1);
  brownian.act(1);
  for (std::size_t i = 0; i < 250; ++i) {
    const NotingBody& body = brownian.engine.bodies[i];
    EXPECT_EQ(body.launches, i < 3 ? 1 : 0) << "body " << i;
    EXPECT_LE(length(body.linearVelocity()), 0.75 * side * (1 + 1e-6));
  }
  for (std::uint32_t frame = 2; frame <= 84; ++frame) brownian.act(frame);  // 252 launches
  for (std::size_t i = 0; i < 250; ++i) {
    EXPECT_EQ(brownian.engine.bodies[i].launches, i < 2 ? 2 : 1) << "body " << i;
  }
}

TEST(Gravity, StartsStrongAndSideways) {
  Rehearsal gravity("gravity", 100);
  EXPECT_NEAR(gravity.engine.noted_gravity[0], 4 * 0.0981 * 10, 1e-6);
  EXPECT_EQ(gravity.engine.noted_gravity[1], 0);
  EXPECT_EQ(gravity.engine.noted_gravity[2], 0);

  gravity.act(1);
  const TurningDirection next = turned({}, 2 * std::numbers::pi / 30 / 6.2);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(gravity.engine.noted_gravity[axis], 4 * 0.0981 * 10 * next.direction[axis], 1e-5);
  }
}

TEST(Gravity, DirectionTurnsAboutAnAxisThatTurnsItself) {
  const double angle = 0.4;
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  const TurningDirection once = turned({}, angle);
  EXPECT_NEAR(once.axis[0], -s, 1e-6);
  EXPECT_NEAR(once.axis[1], c, 1e-6);
  EXPECT_NEAR(once.axis[2], 0, 1e-6);
  // Rodrigues' formula for (1, 0, 0) about (-s, c, 0).
  EXPECT_NEAR(once.direction[0], c + s * s * (1 - c), 1e-6);
  EXPECT_NEAR(once.direction[1], -s * c * (1 - c), 1e-6);
  EXPECT_NEAR(once.direction[2], -c * s, 1e-6);

  const TurningDirection quarter = turned({}, std::numbers::pi / 2);
  EXPECT_NEAR(quarter.direction[0], 1, 1e-6) << "turned about itself";
}

TEST(Gravity, DirectionKeepsItsLengthAndTheAxisItsPeriod) {
  TurningDirection turning;
  const int steps = 186;  // one period of 6.2 s at 30 frames per second
  for (int i = 0; i < 100 * steps; ++i) turning = turned(turning, 2 * std::numbers::pi / steps);
  EXPECT_NEAR(length(turning.direction), 1, 1e-6);
  EXPECT_NEAR(turning.axis[0], 0, 1e-2);
  EXPECT_NEAR(turning.axis[1], 1, 1e-4);
}

}  // namespace
}  // namespace broadmark::scenes
