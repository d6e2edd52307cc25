// Every physics engine: bodies fall, come to rest, stay inside the walls and freeze.

#include "broadmark/scenes/physics_engine.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "broadmark/scenes/registry.h"
#include "entries.h"

namespace broadmark::scenes {
namespace {

const BoxShape kUnitCube{{0.5F, 0.5F, 0.5F}};

std::vector<EngineEntry> enginesWith(std::initializer_list<Dynamics> wanted) {
  std::vector<EngineEntry> found;
  for (const EngineEntry& entry : engineEntries()) {
    if (std::ranges::find(wanted, entry.listing.dynamics) != wanted.end()) found.push_back(entry);
  }
  return found;
}

std::unique_ptr<PhysicsEngine> kinematicEngine(const PhysicsSettings& settings = {}) {
  return entryOf(engineEntries(), "kinematic", "engine").create(settings);
}

/// Engines with gravity, velocities and walls.
class PhysicsEngineTest : public testing::TestWithParam<EngineEntry> {
 protected:
  static std::unique_ptr<PhysicsEngine> makeEngine(const PhysicsSettings& settings = {}) {
    return GetParam().create(settings);
  }

  static PhysicsBody& addCube(PhysicsEngine& engine, const Vec3& position,
                              const Vec3& velocity = {}) {
    return engine.addBody({.shape = kUnitCube,
                           .mass = 1,
                           .pose = {.position = position},
                           .linear_velocity = velocity});
  }

  /// Adds a cube under gravity, and freezes it in motion.
  static PhysicsBody& addFrozenCube(PhysicsEngine& engine) {
    engine.setGravity({0, -10, 0});
    PhysicsBody& body = addCube(engine, {0, 0, 0}, {1, 2, 3});
    engine.step();
    body.freeze();
    return body;
  }

  static void step(PhysicsEngine& engine, int count) {
    for (int i = 0; i < count; ++i) engine.step();
  }

  /// An engine with gravity and a floor at this height.
  static std::unique_ptr<PhysicsEngine> makeFloor(float height) {
    auto engine = makeEngine();
    engine->setGravity({0, -10, 0});
    engine->addWall({.normal = {0, 1, 0}, .offset = height});
    return engine;
  }
};

/// Shapes with the height of their centre above the floor when they rest on it.
const std::pair<Shape, float> kRestingShapes[] = {{kUnitCube, 0.5F}, {SphereShape{0.7F}, 0.7F}};

/// Engines with collisions between bodies.
class RigidEngineTest : public PhysicsEngineTest {};

TEST_P(PhysicsEngineTest, BodiesFallAsGravityTells) {
  auto engine = makeEngine();
  engine->setGravity({0, -10, 0});
  PhysicsBody& body = addCube(*engine, {1, 2, 3});
  step(*engine, 30);
  EXPECT_NEAR(body.linearVelocity()[1], -10, 0.01);
  EXPECT_NEAR(body.pose().position[1], 2 - 5, 0.1);  // first-order integration
  EXPECT_EQ(body.pose().position[0], 1);
  EXPECT_EQ(body.pose().position[2], 3);
}

TEST_P(PhysicsEngineTest, ABodyComesToRestOnTheFloor) {
  for (const auto& [shape, height] : kRestingShapes) {
    auto engine = makeFloor(-4);
    PhysicsBody& body = engine->addBody({.shape = shape, .pose = {.position = {0, -3, 0}}});
    EXPECT_FALSE(engine->allAsleep());
    step(*engine, 200);
    EXPECT_TRUE(engine->allAsleep());
    EXPECT_NEAR(body.pose().position[1], -4 + height, 0.02);

    engine->setGravity({10, 0, 0});
    EXPECT_FALSE(engine->allAsleep()) << "a change of gravity wakes the bodies";
    step(*engine, 10);
    EXPECT_GT(body.pose().position[0], 0.1);
  }
}

TEST_P(RigidEngineTest, AStackComesToRestWithBodiesOfTheRightSize) {
  for (const auto& [shape, height] : kRestingShapes) {
    auto engine = makeFloor(-4);
    PhysicsBody& lower = engine->addBody({.shape = shape, .pose = {.position = {0, -3, 0}}});
    PhysicsBody& upper = addCube(*engine, {0, -1, 0});
    EXPECT_FALSE(engine->allAsleep());
    step(*engine, 200);
    EXPECT_TRUE(engine->allAsleep());
    EXPECT_NEAR(lower.pose().position[1], -4 + height, 0.02);
    EXPECT_NEAR(upper.pose().position[1], -4 + 2 * height + 0.5F, 0.03);
  }
}

TEST_P(RigidEngineTest, ABodyAtRestIsPushedAway) {
  auto engine = makeFloor(0);
  PhysicsBody& resting = addCube(*engine, {0, 0.5F, 0});
  PhysicsBody& fast = addCube(*engine, {-9, 0.5F, 0});
  step(*engine, 40);
  fast.setVelocity({15, 0, 0}, {});
  step(*engine, 60);
  EXPECT_GT(resting.pose().position[0], 0.3);
}

TEST_P(RigidEngineTest, ALeverAtRestTipsUnderALoad) {
  auto engine = makeFloor(0);
  addCube(*engine, {0, 0.5F, 0});
  PhysicsBody& lever =
      engine->addBody({.shape = BoxShape{{2, 0.1F, 0.5F}}, .pose = {.position = {0, 1.1F, 0}}});
  step(*engine, 40);
  ASSERT_NEAR(lever.pose().position[1], 1.1, 0.02);
  addCube(*engine, {1.4F, 1.9F, 0});
  float turned = 0;
  for (int i = 0; i < 60; ++i) {
    engine->step();
    turned = std::max(turned, std::abs(lever.pose().rotation[2]));
  }
  EXPECT_GT(turned, 0.1);
}

TEST_P(RigidEngineTest, SpheresTouchAtTheSumOfTheirRadii) {
  auto engine = makeEngine({.restitution = 1});
  PhysicsBody& still = engine->addBody({.shape = SphereShape{0.5F}});
  PhysicsBody& moving = engine->addBody(
      {.shape = SphereShape{1}, .pose = {.position = {-5, 0, 0}}, .linear_velocity = {2, 0, 0}});
  double nearest = 5;
  for (int i = 0; i < 90; ++i) {
    engine->step();
    nearest = std::min<double>(nearest, still.pose().position[0] - moving.pose().position[0]);
  }
  EXPECT_GT(nearest, 1.48);
  EXPECT_LT(nearest, 1.5 + 2.0 / 30) << "more than the way of a frame";
  // Bodies of equal mass exchange their velocities.
  EXPECT_NEAR(still.linearVelocity()[0], 2, 0.05);
  EXPECT_NEAR(moving.linearVelocity()[0], 0, 0.05);
}

/// The farthest and the last position of the centre of a cube that flies towards a wall at 5.
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
      // Per step: half of the cube's edge, and more than its edge.
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
  // Oblique gravity simulates a slope: the body slides if the ratio exceeds the friction.
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

TEST_P(RigidEngineTest, FrozenBodiesAreObstaclesForGood) {
  auto engine = makeEngine();
  PhysicsBody& obstacle = addFrozenCube(*engine);
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
  auto engine = makeFloor(0);
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

TEST_P(RigidEngineTest, AFrozenBodyIsInTheWayWhereItWasPlaced) {
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

TEST_P(PhysicsEngineTest, FrozenBodiesStayWhateverHappens) {
  auto engine = makeEngine();
  PhysicsBody& body = addFrozenCube(*engine);
  const Pose pose = body.pose();
  body.setVelocity({5, 5, 5}, {1, 1, 1});
  engine->setGravity({0, -20, 0});
  step(*engine, 20);
  EXPECT_TRUE(body.frozen());
  EXPECT_TRUE(body.asleep());
  EXPECT_TRUE(engine->allAsleep());
  EXPECT_EQ(body.pose(), pose);
  EXPECT_EQ(body.linearVelocity(), Vec3{});
}

TEST_P(PhysicsEngineTest, BodiesTurnAtTheirAngularVelocity) {
  auto engine = makeEngine({.angular_damping = 0});
  const auto quarter = static_cast<float>(std::numbers::pi / 2);
  PhysicsBody& body = engine->addBody({.shape = kUnitCube, .angular_velocity = {0, quarter, 0}});
  step(*engine, 30);
  const auto half = static_cast<float>(std::numbers::sqrt2 / 2);
  const std::array<float, 4> expected = {0, half, 0, half};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(body.pose().rotation[i], expected[i], 1e-3);
}

TEST_P(PhysicsEngineTest, DampingTakesItsShareOfTheVelocityPerSecond) {
  auto engine = makeEngine({.linear_damping = 0.4, .angular_damping = 0.3});
  PhysicsBody& body = engine->addBody(
      {.shape = kUnitCube, .linear_velocity = {10, 0, 0}, .angular_velocity = {0, 0, 5}});
  step(*engine, 30);
  EXPECT_NEAR(body.linearVelocity()[0], 6, 0.1);
  EXPECT_NEAR(body.angularVelocity()[2], 3.5, 0.1);
}

TEST_P(PhysicsEngineTest, BodiesComeAndGo) {
  auto engine = makeFloor(-100);
  PhysicsBody& first = addCube(*engine, {0, 0, 0});
  PhysicsBody* second = &addCube(*engine, {5, 0, 0});
  step(*engine, 3);
  const float height = second->pose().position[1];
  engine->removeBody(first);
  step(*engine, 1);
  EXPECT_LT(second->pose().position[1], height) << "the other one falls on";
  PhysicsBody& third = addCube(*engine, {0, 0, 0}, {1, 0, 0});
  step(*engine, 30);
  EXPECT_NEAR(third.pose().position[0], 1, 0.01);
  EXPECT_NEAR(third.pose().position[1], -5, 0.2) << "falls from where it appeared";
  engine->removeBody(*second);
  engine->removeBody(third);
  EXPECT_TRUE(engine->allAsleep()) << "no body is left";
  step(*engine, 1);
}

TEST_P(RigidEngineTest, AStackWhoseLowestBodyVanishesFalls) {
  for (const int frames : {25, 300}) {  // at rest; asleep
    auto engine = makeFloor(0);
    std::vector<PhysicsBody*> stack;
    for (int i = 0; i < 5; ++i) {
      stack.push_back(&addCube(*engine, {0, 0.5F + static_cast<float>(i), 0}));
    }
    step(*engine, frames);
    ASSERT_TRUE(frames != 300 || engine->allAsleep());
    engine->removeBody(*stack[0]);
    EXPECT_FALSE(engine->allAsleep());
    step(*engine, 60);
    for (int i = 1; i < 5; ++i) {
      EXPECT_NEAR(stack[i]->pose().position[1], i - 0.5, 0.05) << "cube " << i << ' ' << frames;
    }
  }
}

TEST_P(RigidEngineTest, OnlyThoseTouchedByABodyThatVanishesWake) {
  auto engine = makeFloor(0);
  PhysicsBody& lower = addCube(*engine, {0, 0.5F, 0});
  PhysicsBody& upper = addCube(*engine, {0, 1.5F, 0});
  PhysicsBody& far_off = addCube(*engine, {9, 0.5F, 0});
  PhysicsBody& fixed = addCube(*engine, {1.01F, 0.5F, 0});
  fixed.freeze();
  step(*engine, 300);
  ASSERT_TRUE(engine->allAsleep());
  engine->removeBody(lower);
  EXPECT_FALSE(upper.asleep());
  EXPECT_TRUE(far_off.asleep());
  EXPECT_TRUE(fixed.asleep());
}

TEST_P(RigidEngineTest, LayersThatDoNotCollidePassThroughEachOther) {
  for (const bool collide : {false, true}) {
    auto engine = makeEngine();
    engine->setLayers(LayerMatrix().set(0, 0).set(3, 31, collide));
    engine->setGravity({0, -10, 0});
    engine->addWall({.normal = {0, 1, 0}, .offset = 0});
    const auto add = [&](float height, std::uint8_t layer) -> PhysicsBody& {
      return engine->addBody(
          {.shape = kUnitCube, .pose = {.position = {0, height, 0}}, .layer = layer});
    };
    const PhysicsBody& lower = add(0.5F, 31);
    const PhysicsBody& upper = add(2, 3);
    step(*engine, 60);
    EXPECT_NEAR(lower.pose().position[1], 0.5, 0.02) << "the floor holds every layer";
    EXPECT_NEAR(upper.pose().position[1], collide ? 1.5 : 0.5, 0.03);
  }
}

// The Bullet engine holds resting bodies in place, but only while they are supported.
TEST(BulletEngine, AStackThatLosesItsLowestBodyFalls) {
  const auto engine = entryOf(engineEntries(), "bullet", "engine").create({});
  engine->setGravity({0, -10, 0});
  engine->addWall({.normal = {0, 1, 0}, .offset = 0});
  std::vector<PhysicsBody*> stack;
  for (int i = 0; i < 5; ++i) {
    const float height = 0.5F + static_cast<float>(i);
    stack.push_back(&engine->addBody({.shape = kUnitCube, .pose = {.position = {0, height, 0}}}));
  }
  for (int i = 0; i < 25; ++i) engine->step();  // at rest, not asleep
  stack[0]->setPose({.position = {9, 0.5F, 0}});
  for (int i = 0; i < 60; ++i) engine->step();
  for (int i = 1; i < 5; ++i) {
    EXPECT_NEAR(stack[i]->pose().position[1], i - 0.5, 0.05) << "cube " << i;
  }
}

TEST(KinematicEngine, BouncesAsHighAsTheRestitutionTells) {
  for (const double restitution : {0.0, 0.5, 1.0}) {
    auto engine = kinematicEngine({.restitution = restitution});
    engine->setGravity({0, -10, 0});
    engine->addWall({.normal = {0, 1, 0}, .offset = 0});
    const double height = 3;
    PhysicsBody& body =
        engine->addBody({.shape = SphereShape{0.5F}, .pose = {.position = {0, 3.5F, 0}}});
    double apex = 0;
    bool bounced = false;
    for (int i = 0; i < 60; ++i) {
      engine->step();
      bounced = bounced || body.linearVelocity()[1] > 0;
      const double above = body.pose().position[1] - 0.5;
      EXPECT_GE(above, -1e-6);
      if (bounced) apex = std::max(apex, above);
    }
    // The rest of the substep of the impact is lost, and the apex may be between two substeps.
    EXPECT_NEAR(apex, height * restitution * restitution, 0.01);
  }
}

TEST(KinematicEngine, BodiesPassThroughEachOther) {
  auto engine = kinematicEngine();
  PhysicsBody& still = engine->addBody({.shape = kUnitCube});
  PhysicsBody& moving = engine->addBody(
      {.shape = kUnitCube, .pose = {.position = {-2, 0, 0}}, .linear_velocity = {3, 0, 0}});
  for (int i = 0; i < 30; ++i) engine->step();
  EXPECT_NEAR(moving.pose().position[0], 1, 1e-4);
  EXPECT_EQ(still.pose().position, Vec3{});
}

TEST(KinematicEngine, TurningBodiesKeepTheirTightBoxInside) {
  auto engine = kinematicEngine({.restitution = 1, .angular_damping = 0});
  engine->setGravity({0, -10, 0});
  for (int axis = 0; axis < 3; ++axis) {
    for (const float sign : {-1.0F, 1.0F}) {
      HalfSpace wall{.offset = -5};
      wall.normal[axis] = sign;
      engine->addWall(wall);
    }
  }
  PhysicsBody& body = engine->addBody({.shape = BoxShape{{3, 0.2F, 0.5F}},
                                       .linear_velocity = {20, -3, 7},
                                       .angular_velocity = {1, 2, 6}});
  for (int i = 0; i < 300; ++i) {
    engine->step();
    const Aabb box = tightBox(body.shape(), body.pose());
    for (int axis = 0; axis < 3; ++axis) {
      ASSERT_GE(box.min[axis], -5 - 1e-5) << "frame " << i;
      ASSERT_LE(box.max[axis], 5 + 1e-5) << "frame " << i;
    }
  }
}

/// A cube of walls with this edge, around the origin.
void addRoom(PhysicsEngine& engine, float edge) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const float sign : {-1.0F, 1.0F}) {
      HalfSpace wall{.offset = -edge / 2};
      wall.normal[axis] = sign;
      engine.addWall(wall);
    }
  }
}

TEST(KinematicEngine, WithoutLossBodiesReflectAtTheWallsAtAnySpeed) {
  // Ten times through the room in a substep, as the centre moves: a triangle wave.
  for (const float speed : {0.001F, 0.3F, 7.0F, 500.0F, 3300.0F}) {
    auto engine = kinematicEngine({.substeps = 1, .friction = 0, .restitution = 1});
    addRoom(*engine, 11);
    PhysicsBody& body = engine->addBody({.shape = kUnitCube, .linear_velocity = {speed, 0, speed}});
    const double time = PhysicsSettings().time_step;
    for (int i = 1; i <= 200; ++i) {
      engine->step();
      const double way = std::fmod(speed * time * i + 5, 20);
      const double expected = way < 10 ? way - 5 : 15 - way;
      ASSERT_NEAR(body.pose().position[0], expected, 1e-4 + 1e-5 * speed * i) << speed << " " << i;
      ASSERT_EQ(body.pose().position[0], body.pose().position[2]);
      ASSERT_EQ(body.pose().position[1], 0);
    }
    EXPECT_FALSE(body.asleep());
    EXPECT_FLOAT_EQ(std::abs(body.linearVelocity()[0]), speed);
  }
}

TEST(KinematicEngine, ABodyLargerThanTheRoomStaysThere) {
  auto engine = kinematicEngine({.friction = 0, .restitution = 1});
  addRoom(*engine, 2);
  PhysicsBody& body =
      engine->addBody({.shape = BoxShape{{3, 0.5F, 0.5F}}, .linear_velocity = {5, 1, 0}});
  for (int i = 0; i < 50; ++i) engine->step();
  EXPECT_LE(std::abs(body.pose().position[0]), 2);
  EXPECT_LE(std::abs(body.pose().position[1]), 0.5F);
}

const auto id_of_engine = [](const auto& param) { return param.param.listing.id; };
INSTANTIATE_TEST_SUITE_P(All, PhysicsEngineTest,
                         testing::ValuesIn(enginesWith({Dynamics::rigid, Dynamics::passing})),
                         id_of_engine);
INSTANTIATE_TEST_SUITE_P(All, RigidEngineTest, testing::ValuesIn(enginesWith({Dynamics::rigid})),
                         id_of_engine);

}  // namespace
}  // namespace broadmark::scenes
