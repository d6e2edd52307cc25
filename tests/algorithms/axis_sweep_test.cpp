// Bullet's sweep: what our beginning and our positions change about it.

#include <gtest/gtest.h>

#include <cmath>

#include "algorithms/runs.h"

namespace broadmark::tests {
namespace {

/// A run of axis-sweep from this initial pose.
TestRun startedAt(const std::vector<Aabb>& first, const SceneInfo& scene) {
  TestRun run(algorithmOf("axis-sweep"));
  run.start(scene, first);
  return run;
}
TestRun startedAt(const std::vector<Aabb>& first) { return startedAt(first, sceneOf({first})); }

std::vector<Aabb> shifted(std::vector<Aabb> boxes, float way) {
  for (Aabb& box : boxes) {
    for (int axis = 0; axis < 3; ++axis) {
      box.min[axis] += way;
      box.max[axis] += way;
    }
  }
  return boxes;
}

// Bullet would insert them one by one: about n²/3 swaps on each axis.
TEST(AxisSweep, TakesInManyBodiesAtOnce) {
  constexpr std::uint64_t kCount = 20'000;
  const std::vector<Aabb> boxes = inputs::uniform(kCount, 0, 1);
  TestRun run = startedAt(boxes);
  auto counters = countersOf(run.broadPhase());
  EXPECT_EQ(counters.at("swaps"), 0U);
  EXPECT_GT(counters.at("first tests"), 0U);
  EXPECT_LT(counters.at("first tests"), kCount * kCount / 20);
  EXPECT_EQ(counters.at("moves"), kCount);
  EXPECT_EQ(sorted(run.step(boxes)), sweptPairs(boxes));
  EXPECT_EQ(countersOf(run.broadPhase()).at("moves"), 0U);
}

// One axis on which all boxes meet must not be the one that is swept.
TEST(AxisSweep, SweepsFirstAlongTheBestAxis) {
  for (std::size_t best = 0; best < 3; ++best) {
    std::vector<Aabb> boxes = inputs::uniform(1000, 0, 1);
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      boxes[i].min[best] = static_cast<float>(2 * i);
      boxes[i].max[best] = static_cast<float>(2 * i + 1);
    }
    EXPECT_EQ(countersOf(startedAt(boxes).broadPhase()).at("first tests"), 0U) << best;
  }
}

TEST(AxisSweep, WorksOnlyForWhatMoves) {
  std::vector<Aabb> boxes = inputs::uniform(1000, 0, 1);
  TestRun run = startedAt(boxes);
  run.step(boxes);
  EXPECT_EQ(countersOf(run.broadPhase()).at("moves"), 0U);
  EXPECT_EQ(countersOf(run.broadPhase()).at("swaps"), 0U);

  boxes[7] = shifted({boxes[7]}, 0.01F)[0];
  EXPECT_EQ(sorted(run.step(boxes)), bruteForcePairs(boxes));
  EXPECT_EQ(countersOf(run.broadPhase()).at("moves"), 1U);
  EXPECT_LT(countersOf(run.broadPhase()).at("swaps"), 100U);

  // All move alike: one passes another for a moment only.
  boxes = shifted(boxes, 50);
  EXPECT_EQ(sorted(run.step(boxes)), bruteForcePairs(boxes));
  EXPECT_EQ(countersOf(run.broadPhase()).at("moves"), 1000U);
  EXPECT_GT(countersOf(run.broadPhase()).at("swaps"), 0U);
}

// Bullet's own positions end at the borders of a world given beforehand.
TEST(AxisSweep, HasNoWorldToLeave) {
  std::vector<Aabb> boxes = inputs::uniform(300, 0, 1);
  SceneInfo scene = sceneOf({boxes});
  scene.world = {{0, 0, 0, 0}, {1, 1, 1, 0}};
  TestRun run = startedAt(boxes, scene);
  for (const float way : {5.0F, -1e3F, 1e6F, -3e6F, 0.0F}) {
    boxes = shifted(inputs::uniform(300, 1, 1), way);
    EXPECT_EQ(sorted(run.step(boxes)), bruteForcePairs(boxes)) << way;
    EXPECT_EQ(run.broadPhase().validate(), "") << way;
  }
  // One body off to nearly infinity does not drive the others together.
  boxes[0] = {{3e38F, 3e38F, 3e38F, 0}, {3.1e38F, 3.1e38F, 3.1e38F, 0}};
  EXPECT_EQ(sorted(run.step(boxes)), bruteForcePairs(boxes));
  boxes[1] = shifted({boxes[1]}, 0.01F)[0];
  EXPECT_EQ(sorted(run.step(boxes)), bruteForcePairs(boxes));
  EXPECT_LT(countersOf(run.broadPhase()).at("swaps"), 50U);
}

// Positions lack the last bit of the floats; the answer must not.
TEST(AxisSweep, TellsNeighbouringFloatsApart) {
  for (const float place : {1.0F, -1.0F, 100.0F, -0.3F, 1e-40F, 1e30F}) {
    const float next = std::nextafter(place, 1e38F);
    const float after = std::nextafter(next, 1e38F);
    for (const float begin : {place, next, after}) {
      for (const float end : {place, next, after}) {
        const std::vector<Aabb> boxes = {{{place - 1, 0, 0, 0}, {end, 1, 1, 0}},
                                         {{begin, 0, 0, 0}, {begin + 1, 1, 1, 0}}};
        TestRun run = startedAt(inputs::uniform(2, 0, 1));
        EXPECT_EQ(sorted(run.step(boxes)), bruteForcePairs(boxes)) << begin << " " << end;
      }
    }
  }
}

// Nor must events: two ends may meet and part without a swap.
TEST(AxisSweep, TellsTheEventsOfNeighbouringFloats) {
  for (const float place : {1.0F, -1.0F, 100.0F, -0.3F, 1e-40F}) {
    TestRun run(algorithmOf("axis-sweep"), {.answer = AnswerKind::events});
    inputs::Random random(1, 1);
    const auto nearby = [&] {
      float one = place;
      for (int steps = random.integer(0, 3); steps > 0; --steps) one = std::nextafter(one, 1e38F);
      return one;
    };
    std::vector<Aabb> boxes = {{{place - 1, 0, 0, 0}, {place, 1, 1, 0}},
                               {{place, 0, 0, 0}, {place + 1, 1, 1, 0}}};
    run.start(boxes);
    for (int frame = 0; frame < 100; ++frame) {
      if (random.integer(0, 2) > 0) boxes[0].max[0] = nearby();
      if (random.integer(0, 2) > 0) boxes[1].min[0] = nearby();
      if (frame % 10 == 0) boxes = shifted(boxes, frame % 20 == 0 ? 0.5F : -0.5F);
      EXPECT_EQ(sorted(run.step(boxes)), bruteForcePairs(boxes)) << place << ", frame " << frame;
    }
  }
}

TEST(AxisSweep, SurvivesTheLimitsOfFloats) {
  TestRun run = startedAt(inputs::limits(300, 0, 1));
  for (std::uint32_t frame = 1; frame < 4; ++frame) {
    const std::vector<Aabb> boxes = inputs::limits(300, frame, 1);
    EXPECT_EQ(sorted(run.step(boxes)), bruteForcePairs(boxes));
    EXPECT_EQ(run.broadPhase().validate(), "");
  }
}

TEST(AxisSweep, InstancesDoNotDisturbEachOther) {
  const std::vector<Aabb> some = inputs::clustered(200, 0, 1);
  const std::vector<Aabb> others = inputs::clustered(100, 0, 2);
  TestRun a = startedAt(some);
  TestRun b = startedAt(others);
  for (std::uint32_t frame = 1; frame < 4; ++frame) {
    const std::vector<Aabb> some_next = inputs::clustered(200, frame, 1);
    const std::vector<Aabb> others_next = inputs::clustered(100, frame, 2);
    EXPECT_EQ(sorted(a.step(some_next)), bruteForcePairs(some_next));
    EXPECT_EQ(sorted(b.step(others_next)), bruteForcePairs(others_next));
  }
}

TEST(AxisSweep, StatesHowManyBodiesItsHandlesAllow) {
  EXPECT_EQ(algorithmOf("axis-sweep").traits.max_objects, 0x7FFF'FFFDU);
}

}  // namespace
}  // namespace broadmark::tests
