// Bullet's sweep, with the adapter's bulk initialisation and integer positions.

#include <gtest/gtest.h>

#include <cmath>

#include "algorithms/runs.h"

namespace broadmark::tests {
namespace {

/// A run of axis-sweep with this initial pose.
TestRun startedAt(const std::vector<Aabb>& first, const SceneInfo& scene) {
  TestRun test_run(algorithmOf("axis-sweep"));
  test_run.start(scene, first);
  return test_run;
}
TestRun startedAt(const std::vector<Aabb>& first) { return startedAt(first, sceneOf({first})); }

std::vector<Aabb> shifted(std::vector<Aabb> boxes, float offset) {
  for (Aabb& box : boxes) {
    for (int axis = 0; axis < 3; ++axis) {
      box.min[axis] += offset;
      box.max[axis] += offset;
    }
  }
  return boxes;
}

// Bullet would insert bodies one by one: about n²/3 swaps on each axis.
TEST(AxisSweep, TakesInManyBodiesAtOnce) {
  constexpr std::uint64_t kCount = 20'000;
  const std::vector<Aabb> boxes = inputs::uniform(kCount, 0, 1);
  TestRun test_run = startedAt(boxes);
  auto counters = countersOf(test_run.broadPhase());
  EXPECT_EQ(counters.at("swaps"), 0U);
  EXPECT_GT(counters.at("first tests"), 0U);
  EXPECT_LT(counters.at("first tests"), kCount * kCount / 20);
  EXPECT_EQ(counters.at("moves"), kCount);
  EXPECT_EQ(sorted(test_run.step(boxes)), sweptPairs(boxes));
  EXPECT_EQ(countersOf(test_run.broadPhase()).at("moves"), 0U);
}

// An axis on which all boxes overlap must not be the sweep axis.
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
  TestRun test_run = startedAt(boxes);
  test_run.step(boxes);
  EXPECT_EQ(countersOf(test_run.broadPhase()).at("moves"), 0U);
  EXPECT_EQ(countersOf(test_run.broadPhase()).at("swaps"), 0U);

  boxes[7] = shifted({boxes[7]}, 0.01F)[0];
  EXPECT_EQ(sorted(test_run.step(boxes)), bruteForcePairs(boxes));
  EXPECT_EQ(countersOf(test_run.broadPhase()).at("moves"), 1U);
  EXPECT_LT(countersOf(test_run.broadPhase()).at("swaps"), 100U);

  // All move by the same offset: endpoints are only swapped temporarily.
  boxes = shifted(boxes, 50);
  EXPECT_EQ(sorted(test_run.step(boxes)), bruteForcePairs(boxes));
  EXPECT_EQ(countersOf(test_run.broadPhase()).at("moves"), 1000U);
  EXPECT_GT(countersOf(test_run.broadPhase()).at("swaps"), 0U);
}

// Bullet's own positions are bounded by a predefined world.
TEST(AxisSweep, HasNoWorldToLeave) {
  std::vector<Aabb> boxes = inputs::uniform(300, 0, 1);
  SceneInfo scene = sceneOf({boxes});
  scene.world = {{0, 0, 0, 0}, {1, 1, 1, 0}};
  TestRun test_run = startedAt(boxes, scene);
  for (const float offset : {5.0F, -1e3F, 1e6F, -3e6F, 0.0F}) {
    boxes = shifted(inputs::uniform(300, 1, 1), offset);
    EXPECT_EQ(sorted(test_run.step(boxes)), bruteForcePairs(boxes)) << offset;
    EXPECT_EQ(test_run.broadPhase().validate(), "") << offset;
  }
  // A body near infinity does not make the others overlap.
  boxes[0] = {{3e38F, 3e38F, 3e38F, 0}, {3.1e38F, 3.1e38F, 3.1e38F, 0}};
  EXPECT_EQ(sorted(test_run.step(boxes)), bruteForcePairs(boxes));
  boxes[1] = shifted({boxes[1]}, 0.01F)[0];
  EXPECT_EQ(sorted(test_run.step(boxes)), bruteForcePairs(boxes));
  EXPECT_LT(countersOf(test_run.broadPhase()).at("swaps"), 50U);
}

// Positions lack the last bit of the floats; the answer must still be exact.
TEST(AxisSweep, TellsNeighbouringFloatsApart) {
  for (const float x : {1.0F, -1.0F, 100.0F, -0.3F, 1e-40F, 1e30F}) {
    const float next = std::nextafter(x, 1e38F);
    const float after = std::nextafter(next, 1e38F);
    for (const float begin : {x, next, after}) {
      for (const float end : {x, next, after}) {
        const std::vector<Aabb> boxes = {{{x - 1, 0, 0, 0}, {end, 1, 1, 0}},
                                         {{begin, 0, 0, 0}, {begin + 1, 1, 1, 0}}};
        TestRun test_run = startedAt(inputs::uniform(2, 0, 1));
        EXPECT_EQ(sorted(test_run.step(boxes)), bruteForcePairs(boxes)) << begin << " " << end;
      }
    }
  }
}

// Events must be exact, too: an overlap may begin or end without a swap.
TEST(AxisSweep, TellsTheEventsOfNeighbouringFloats) {
  for (const float x : {1.0F, -1.0F, 100.0F, -0.3F, 1e-40F}) {
    TestRun test_run(algorithmOf("axis-sweep"), {.answer = AnswerKind::events});
    inputs::Random random(1, 1);
    const auto nearby = [&] {
      float value = x;
      for (int i = random.integer(0, 3); i > 0; --i) value = std::nextafter(value, 1e38F);
      return value;
    };
    std::vector<Aabb> boxes = {{{x - 1, 0, 0, 0}, {x, 1, 1, 0}}, {{x, 0, 0, 0}, {x + 1, 1, 1, 0}}};
    test_run.start(boxes);
    for (int frame = 0; frame < 100; ++frame) {
      if (random.integer(0, 2) > 0) boxes[0].max[0] = nearby();
      if (random.integer(0, 2) > 0) boxes[1].min[0] = nearby();
      if (frame % 10 == 0) boxes = shifted(boxes, frame % 20 == 0 ? 0.5F : -0.5F);
      EXPECT_EQ(sorted(test_run.step(boxes)), bruteForcePairs(boxes)) << x << ", frame " << frame;
    }
  }
}

TEST(AxisSweep, SurvivesTheLimitsOfFloats) {
  TestRun test_run = startedAt(inputs::limits(300, 0, 1));
  for (std::uint32_t frame = 1; frame < 4; ++frame) {
    const std::vector<Aabb> boxes = inputs::limits(300, frame, 1);
    EXPECT_EQ(sorted(test_run.step(boxes)), bruteForcePairs(boxes));
    EXPECT_EQ(test_run.broadPhase().validate(), "");
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
