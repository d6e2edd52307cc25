// Every physics engine: bodies fall, rest, stay inside and freeze as a scene expects.

#include "scenes/physics_engine.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "scenes/registry.h"

namespace broadmark::scenes {
namespace {

const BoxShape kUnitCube{{0.5F, 0.5F, 0.5F}};

class PhysicsEngineTest : public testing::TestWithParam<std::size_t> {
 protected:
  std::unique_ptr<PhysicsEngine> makeEngine(const PhysicsSettings& settings = {}) {
    return engineEntries()[GetParam()].create(settings);
  }

  static PhysicsBody& addCube(PhysicsEngine& engine, const Vec3& position,
                              const Vec3& velocity = {}) {
    return engine.addBody({.shape = kUnitCube,
                           .mass = 1,
                           .pose = {.position = position},
                           .linear_velocity = velocity});
  }

  static void step(PhysicsEngine& engine, int count) {
    for (int i = 0; i < count; ++i) engine.step();
  }
};

TEST_P(PhysicsEngineTest, BodiesFallAsGravityTells) {
  auto engine = makeEngine();
  engine->setGravity({0, -10, 0});
  PhysicsBody& body = addCube(*engine, {1, 2, 3});
  step(*engine, 30);
  EXPECT_NEAR(body.linearVelocity()[1], -10, 0.01);
  EXPECT_NEAR(body.pose().position[1], 2 - 5, 0.1);  // the integration is of first order
  EXPECT_EQ(body.pose().position[0], 1);
  EXPECT_EQ(body.pose().position[2], 3);
}

TEST_P(PhysicsEngineTest, AStackComesToRestWithBoxesOfTheRightSize) {
  auto engine = makeEngine();
  engine->setGravity({0, -10, 0});
  engine->addWall({.normal = {0, 1, 0}, .offset = -4});
  PhysicsBody& lower = addCube(*engine, {0, -3, 0});
  PhysicsBody& upper = addCube(*engine, {0, -1.5F, 0});
  EXPECT_FALSE(engine->allAsleep());
  step(*engine, 200);
  EXPECT_TRUE(engine->allAsleep());
  EXPECT_NEAR(lower.pose().position[1], -3.5, 0.02);
  EXPECT_NEAR(upper.pose().position[1], -2.5, 0.03);

  engine->setGravity({10, 0, 0});
  EXPECT_FALSE(engine->allAsleep()) << "a change of gravity wakes the bodies";
  step(*engine, 10);
  EXPECT_GT(lower.pose().position[0], 0.1);
}

/// How far the centre of a cube gets that flies at a wall 5 away: the farthest, and the last.
std::pair<float, float> flyAtWall(PhysicsEngine& engine, int axis, float sign, float speed) {
  HalfSpace wall{.offset = -5};
  wall.normal[axis] = -sign;
  engine.addWall(wall);
  Vec3 velocity{};
  velocity[axis] = sign * speed;
  const PhysicsBody& body = engine.addBody(
      {.shape = kUnitCube, .pose = {.position = {0.3F, 0.2F, 0.1F}}, .linear_velocity = velocity});
  float farthest = 0;
  for (int i = 0; i < 60; ++i) {
    engine.step();
    farthest = std::max(farthest, sign * body.pose().position[axis]);
  }
  return {farthest, sign * body.pose().position[axis]};
}

TEST_P(PhysicsEngineTest, WallsStopBodiesThatWouldPassThemInOneStep) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const float sign : {-1.0F, 1.0F}) {
      const PhysicsSettings one_step = {.time_step = 1.0 / 25, .substeps = 1};
      const auto [slow_farthest, slow_last] = flyAtWall(*makeEngine(one_step), axis, sign, 3);
      EXPECT_NEAR(slow_farthest, 4.5, 0.02);
      EXPECT_GT(slow_last, 4);
      // In each step by half of a cube's size, and by more than all of it.
      for (const float speed : {12.0F, 30.0F}) {
        const auto [farthest, last] = flyAtWall(*makeEngine(one_step), axis, sign, speed);
        EXPECT_LT(farthest, 5) << "the centre stays inside at speed " << speed;
        EXPECT_GT(farthest, 4.45);
        EXPECT_LT(last, 4.55) << "comes out of the wall again";
      }
    }
  }
}

TEST_P(PhysicsEngineTest, FrictionHoldsABodyOnASlopeUpToItsCoefficient) {
  // A slope's pull as a sideways part of gravity: slides when its share exceeds the friction.
  for (const bool slides : {false, true}) {
    auto engine = makeEngine({.friction = 0.6});
    engine->addWall({.normal = {0, 1, 0}, .offset = 0});
    engine->setGravity({slides ? 7.0F : 5.0F, -10, 0});
    PhysicsBody& body = addCube(*engine, {0, 0.5F, 0});
    step(*engine, 60);
    const double without_friction = 0.5 * (slides ? 7.0 : 5.0) * 2 * 2;
    if (slides) {
      EXPECT_GT(body.pose().position[0], 0.1);
      EXPECT_LT(body.pose().position[0], 0.5 * without_friction);
    } else {
      EXPECT_LT(std::abs(body.pose().position[0]), 0.05);
    }
  }
}

TEST_P(PhysicsEngineTest, AngularSpeedIsLimited) {
  auto engine = makeEngine({.angular_damping = 0, .max_angular_speed = 7});
  PhysicsBody& fast = engine->addBody({.shape = kUnitCube, .angular_velocity = {0, 100, 0}});
  PhysicsBody& slow = engine->addBody(
      {.shape = kUnitCube, .pose = {.position = {9, 0, 0}}, .angular_velocity = {0, 0, 3}});
  engine->step();
  EXPECT_NEAR(fast.angularVelocity()[1], 7, 1e-4);
  EXPECT_NEAR(slow.angularVelocity()[2], 3, 1e-4);
}

TEST_P(PhysicsEngineTest, FrozenBodiesAreObstaclesForGood) {
  auto engine = makeEngine();
  engine->setGravity({0, -10, 0});
  PhysicsBody& obstacle = addCube(*engine, {0, 0, 0}, {1, 2, 3});
  engine->step();
  obstacle.freeze();
  const Pose pose = obstacle.pose();
  PhysicsBody& falling = addCube(*engine, {pose.position[0], 2, pose.position[2]});
  obstacle.setVelocity({5, 5, 5}, {1, 1, 1});
  engine->setGravity({0, -20, 0});
  step(*engine, 200);
  EXPECT_TRUE(obstacle.frozen());
  EXPECT_TRUE(obstacle.asleep());
  EXPECT_EQ(obstacle.pose(), pose);
  EXPECT_EQ(obstacle.linearVelocity(), Vec3{});
  EXPECT_FALSE(falling.frozen());
  EXPECT_NEAR(falling.pose().position[1], pose.position[1] + 1, 0.03);
  EXPECT_TRUE(falling.asleep()) << "a frozen neighbour lets a body fall asleep";
}

TEST_P(PhysicsEngineTest, LaunchingAndPlacingWakesASleepingBody) {
  auto engine = makeEngine();
  engine->setGravity({0, -10, 0});
  engine->addWall({.normal = {0, 1, 0}, .offset = 0});
  PhysicsBody& body = addCube(*engine, {0, 0.5F, 0});
  step(*engine, 200);
  ASSERT_TRUE(body.asleep());
  body.setVelocity({0, 5, 0}, {});
  EXPECT_FALSE(body.asleep());
  engine->step();
  EXPECT_GT(body.pose().position[1], 0.6);

  step(*engine, 200);
  ASSERT_TRUE(body.asleep());
  body.setPose({.position = {7, 8, 9}});
  EXPECT_EQ(body.pose().position, (Vec3{7, 8, 9}));
  step(*engine, 5);
  EXPECT_LT(body.pose().position[1], 8);
}

TEST_P(PhysicsEngineTest, AFrozenBodyIsInTheWayWhereItWasPlaced) {
  auto engine = makeEngine();
  PhysicsBody& obstacle = addCube(*engine, {0, 0, 0});
  PhysicsBody& moving = addCube(*engine, {15, 0, 0}, {3, 0, 0});
  engine->step();
  obstacle.freeze();
  obstacle.setPose({.position = {20, 0, 0}});
  float farthest = 0;
  for (int i = 0; i < 90; ++i) {
    engine->step();
    farthest = std::max(farthest, moving.pose().position[0]);
  }
  EXPECT_NEAR(farthest, 19, 0.05);
}

TEST_P(PhysicsEngineTest, BodiesAtRestInFreeSpaceCountAsAsleep) {
  auto engine = makeEngine();
  addCube(*engine, {0, 0, 0});
  PhysicsBody& other = addCube(*engine, {5, 0, 0});
  step(*engine, 100);
  EXPECT_TRUE(engine->allAsleep());
  other.setVelocity({1, 0, 0}, {});
  EXPECT_FALSE(engine->allAsleep());
}

INSTANTIATE_TEST_SUITE_P(All, PhysicsEngineTest,
                         testing::Range<std::size_t>(0, engineEntries().size()),
                         [](const auto& param) { return engineEntries()[param.param].listing.id; });

}  // namespace
}  // namespace broadmark::scenes
