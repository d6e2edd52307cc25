// The boids engine: boids form flocks, stay apart and never leave the world.

#include <numbers>

#include "broadmark/scenes/registry.h"
#include "entries.h"
#include "scenes/scene_runs.h"

namespace broadmark::tests {
namespace {

using scenes::PhysicsBody;
using scenes::PhysicsEngine;

const scenes::BoxShape kUnitCube{{0.5F, 0.5F, 0.5F}};

std::unique_ptr<PhysicsEngine> boidsEngine(const ParameterValues& values = {}) {
  auto engine = entryOf(scenes::engineEntries(), "boids", "engine").create({.substeps = 1});
  setParameters(*engine, values);
  return engine;
}

PhysicsBody& launch(PhysicsEngine& engine, const Vec3& position, const Vec3& velocity) {
  return engine.addBody(
      {.shape = kUnitCube, .pose = {.position = position}, .linear_velocity = velocity});
}

/// Adds walls on all sides of a cube of ± half.
void addWalls(PhysicsEngine& engine, float half) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const float sign : {-1.0F, 1.0F}) {
      scenes::HalfSpace wall{.offset = -half};
      wall.normal[axis] = sign;
      engine.addWall(wall);
    }
  }
}

Point point(const Vec3& v) { return {v[0], v[1], v[2]}; }

/// Adds bodies in a ball with equal speeds and random directions.
std::vector<PhysicsBody*> addCrowd(PhysicsEngine& engine, std::size_t count, double radius,
                                   double speed) {
  scenes::Random random(7);
  std::vector<PhysicsBody*> bodies;
  while (bodies.size() < count) {
    Vec3 velocity = random.inBall(1);
    const auto factor = static_cast<float>(speed / lengthOf(point(velocity)));
    for (float& component : velocity) component *= factor;
    bodies.push_back(&launch(engine, random.inBall(radius), velocity));
  }
  return bodies;
}

void step(PhysicsEngine& engine, int count) {
  for (int i = 0; i < count; ++i) engine.step();
}

/// The order parameter of flocking: the length of the mean heading, 1 if all headings are equal.
double polarisation(const std::vector<PhysicsBody*>& bodies) {
  Point sum{};
  for (const PhysicsBody* body : bodies) {
    const Point velocity = point(body->linearVelocity());
    for (int axis = 0; axis < 3; ++axis) sum[axis] += velocity[axis] / lengthOf(velocity);
  }
  return lengthOf(sum) / static_cast<double>(bodies.size());
}

double nearestDistance(const std::vector<PhysicsBody*>& bodies) {
  double nearest = 1e9;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    for (std::size_t a = 0; a < b; ++a) {
      const Point between =
          minus(point(bodies[a]->pose().position), point(bodies[b]->pose().position));
      nearest = std::min(nearest, lengthOf(between));
    }
  }
  return nearest;
}

TEST(BoidsEngine, HeadingsAlign) {
  auto engine = boidsEngine();
  const auto bodies = addCrowd(*engine, 200, 5, 1);
  const double before = polarisation(bodies);
  EXPECT_LT(before, 0.3);
  step(*engine, 150);
  EXPECT_GT(polarisation(bodies), 0.6);

  auto indifferent = boidsEngine({{"alignment", "0"}, {"cohesion", "0"}, {"separation", "0"}});
  const auto loners = addCrowd(*indifferent, 200, 5, 1);
  step(*indifferent, 150);
  EXPECT_NEAR(polarisation(loners), before, 1e-4) << "without the rules nothing aligns";
}

TEST(BoidsEngine, NeighboursKeepTheirDistance) {
  auto engine = boidsEngine();
  const auto bodies = addCrowd(*engine, 200, 4, 3);
  EXPECT_LT(nearestDistance(bodies), 0.4);
  step(*engine, 200);
  EXPECT_GT(nearestDistance(bodies), 0.8);
}

TEST(BoidsEngine, CohesionHoldsAFlockTogether) {
  const auto spread = [](const std::string& cohesion) {
    auto engine = boidsEngine({{"cohesion", cohesion}, {"alignment", "0"}});
    const auto bodies = addCrowd(*engine, 100, 5, 1);
    step(*engine, 300);
    Point middle{};
    for (const PhysicsBody* body : bodies) {
      for (int axis = 0; axis < 3; ++axis) middle[axis] += body->pose().position[axis] / 100.0;
    }
    double sum = 0;
    for (const PhysicsBody* body : bodies) {
      sum += lengthOf(minus(point(body->pose().position), middle)) / 100;
    }
    return sum;
  };
  EXPECT_LT(spread("6"), 0.7 * spread("0"));
}

TEST(BoidsEngine, SpeedStaysNearThatOfTheLaunch) {
  auto engine = boidsEngine({{"min_speed", "0.7"}, {"max_speed", "1.4"}});
  addWalls(*engine, 12);
  engine->setGravity({0, -3, 0});
  const auto bodies = addCrowd(*engine, 150, 6, 4);
  for (int frame = 0; frame < 100; ++frame) {
    engine->step();
    for (const PhysicsBody* body : bodies) {
      EXPECT_LT(lengthOf(point(body->linearVelocity())), 4 * 1.4 + 1e-3);
    }
  }
  EXPECT_FALSE(engine->allAsleep());
}

TEST(BoidsEngine, NoBodyPassesAWallAtAnySpeed) {
  for (const double speed : {2.0, 50.0, 5000.0}) {
    auto engine = boidsEngine();
    addWalls(*engine, 12);
    const auto bodies = addCrowd(*engine, 150, 10, speed);
    for (int frame = 0; frame < 60; ++frame) {
      engine->step();
      for (const PhysicsBody* body : bodies) {
        const Aabb box = tightBox(body->shape(), body->pose());
        for (int axis = 0; axis < 3; ++axis) {
          ASSERT_GE(box.min[axis], -12 - 1e-4) << speed;
          ASSERT_LE(box.max[axis], 12 + 1e-4) << speed;
        }
      }
    }
  }
}

TEST(BoidsEngine, TurnsAwayBeforeItMeetsAWall) {
  auto engine = boidsEngine();
  engine->addWall({.normal = {-1, 0, 0}, .offset = -10});
  PhysicsBody& body = launch(*engine, {0, 0, 0}, {3, 0.1F, 0});
  double farthest = 0;
  for (int frame = 0; frame < 200; ++frame) {
    engine->step();
    farthest = std::max(farthest, double{body.pose().position[0]});
  }
  EXPECT_GT(farthest, 6);
  EXPECT_LT(farthest, 9.49) << "not even touching";
  EXPECT_LT(body.linearVelocity()[0], 0);
}

TEST(BoidsEngine, BodiesPointInTheirDirection) {
  auto engine = boidsEngine();
  PhysicsBody& ahead = launch(*engine, {0, 0, 0}, {2, 0, 0});
  PhysicsBody& aside = launch(*engine, {50, 0, 0}, {0, 0, -2});
  PhysicsBody& up = launch(*engine, {100, 0, 0}, {0, 2, 0});
  engine->step();
  const auto half = static_cast<float>(std::numbers::sqrt2 / 2);
  const std::array<float, 4> expected_ahead = {0, 0, 0, 1};
  const std::array<float, 4> expected_aside = {0, half, 0, half};
  const std::array<float, 4> expected_up = {0, 0, half, half};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(ahead.pose().rotation[i], expected_ahead[i], 1e-6);
    EXPECT_NEAR(aside.pose().rotation[i], expected_aside[i], 1e-6);
    EXPECT_NEAR(up.pose().rotation[i], expected_up[i], 1e-6);
  }
}

TEST(BoidsEngine, FrozenAndUnlaunchedBodiesStay) {
  auto engine = boidsEngine();
  engine->setGravity({0, -10, 0});
  PhysicsBody& frozen = launch(*engine, {0, 0, 0}, {1, 2, 3});
  PhysicsBody& idle = launch(*engine, {1, 0, 0}, {});
  PhysicsBody& flying = launch(*engine, {0, 1, 0}, {1, 0, 0});
  frozen.freeze();
  frozen.setVelocity({5, 5, 5}, {});
  const Pose pose = frozen.pose();
  step(*engine, 30);
  EXPECT_TRUE(frozen.frozen());
  EXPECT_EQ(frozen.pose(), pose);
  EXPECT_EQ(frozen.linearVelocity(), Vec3{});
  EXPECT_EQ(idle.pose().position, (Vec3{1, 0, 0}));
  EXPECT_TRUE(idle.asleep());
  EXPECT_FALSE(flying.asleep());
  EXPECT_FALSE(engine->allAsleep());
  flying.freeze();
  EXPECT_TRUE(engine->allAsleep());
  idle.setVelocity({0, 0, 2}, {});
  EXPECT_FALSE(engine->allAsleep());
  idle.setPose({.position = {30, 30, 30}});
  engine->step();
  EXPECT_GT(idle.pose().position[2], 30);
}

TEST(BoidsEngine, HandlesCrowdsAtOnePlaceAndBodiesFarAway) {
  auto engine = boidsEngine();
  for (int i = 0; i < 3000; ++i) launch(*engine, {0, 0, 0}, {1, 0, 0});
  PhysicsBody& far = launch(*engine, {3e30F, -3e30F, 1e12F}, {1, 0, 0});
  step(*engine, 3);
  EXPECT_TRUE(std::isfinite(far.pose().position[0]));
}

TEST(BoidsEngine, FollowsEveryNeighbourInSight) {
  // The steering of each boid, recomputed by brute force.
  auto engine =
      boidsEngine({{"sight", "4"}, {"separation", "0"}, {"alignment", "1"}, {"cohesion", "0"}});
  const auto bodies = addCrowd(*engine, 60, 7, 2);
  std::vector<Point> positions;
  std::vector<Point> velocities;
  for (const PhysicsBody* body : bodies) {
    positions.push_back(point(body->pose().position));
    velocities.push_back(point(body->linearVelocity()));
  }
  engine->step();
  int with_neighbours = 0;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    Point mean{};
    int seen = 0;
    for (std::size_t k = 0; k < bodies.size(); ++k) {
      if (k == i || lengthOf(minus(positions[k], positions[i])) > 4) continue;
      for (int axis = 0; axis < 3; ++axis) mean[axis] += velocities[k][axis];
      ++seen;
    }
    Point expected = velocities[i];
    for (int axis = 0; axis < 3 && seen > 0; ++axis) {
      expected[axis] += (mean[axis] / seen - velocities[i][axis]) / 30;
    }
    with_neighbours += seen > 0 ? 1 : 0;
    EXPECT_LT(lengthOf(minus(point(bodies[i]->linearVelocity()), expected)), 1e-4) << "boid " << i;
  }
  EXPECT_GT(with_neighbours, 50);
}

TEST(EngineParameters, AreThoseOfTheChosenEngineWithNamesOfTheirOwn) {
  auto simulation = sceneWith("brownian", {{"objects", "40"}, {"frames", "10"}});
  EXPECT_FALSE(parameterValues(*simulation).contains("alignment"));
  setParameters(*simulation, {{"engine", "boids"}, {"alignment", "9.5"}});
  EXPECT_EQ(parameterValues(*simulation).at("alignment"), "9.5");
  const std::vector<Boxes> strong = allFrames(*simulation);
  EXPECT_EQ(allFrames(*simulation), strong) << "kept by rewinding";
  setParameters(*simulation, {{"alignment", "0"}});
  EXPECT_NE(allFrames(*simulation), strong);
  setParameters(*simulation, {{"engine", "bullet"}});
  EXPECT_FALSE(parameterValues(*simulation).contains("alignment"));

  for (const SceneListing& scene : builtinScenes()) {
    for (const EngineListing& engine : availableEngines()) {
      std::vector<std::string> names = parameterNames(*makeSimulation(scene.id, engine.id));
      std::ranges::sort(names);
      EXPECT_EQ(std::ranges::adjacent_find(names), names.end()) << scene.id << ' ' << engine.id;
    }
  }
}

}  // namespace
}  // namespace broadmark::tests
