// What makes times comparable: the answer is the algorithm's own, complete when the search returns,
// and the same however it is run.

#include <gtest/gtest.h>

#include <chrono>

#include "broadmark/runner.h"
#include "algorithms/runs.h"

namespace broadmark::tests {
namespace {

/// Moves every box to where nothing was, in place.
void scramble(std::vector<Aabb>& boxes) {
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const auto x = static_cast<float>(i % 3);
    boxes[i] = {{x, x, x, 0}, {x + 1, x + 1, x + 1, 0}};
  }
}

class HonestClocks : public testing::TestWithParam<Algorithm> {};

// Who reads the caller's boxes after updateObjects, or works when asked for the answer, fails here.
TEST_P(HonestClocks, AnswerDoesNotDependOnBoxesAfterwards) {
  const auto frames = framesOf({"assorted", inputs::assorted}, 500, 4);
  const SceneInfo scene = sceneOf(frames);
  for (const Configuration& way : configurations(GetParam())) {
    SCOPED_TRACE(describe(GetParam(), way));
    Execution execution(way.threads, way.isa);
    try {
      std::vector<Pair> undisturbed;
      {
        Instance run(GetParam(), execution, scene, frames[0]);
        for (std::size_t i = 1; i < frames.size(); ++i) undisturbed = sorted(run.step(frames[i]));
      }
      ASSERT_FALSE(undisturbed.empty());

      std::vector<Aabb> boxes = frames[0];
      Instance run(GetParam(), execution, scene, boxes);
      scramble(boxes);
      for (std::uint32_t i = 1; i < frames.size(); ++i) {
        boxes = frames[i];
        run.broadPhase().updateObjects({i, boxes});
        scramble(boxes);
        run.search();
        scramble(boxes);
      }
      EXPECT_EQ(sorted(run.broadPhase().overlaps()), undisturbed);
    } catch (const UnsupportedError& error) {
      GTEST_SKIP() << error.what();
    }
  }
}

TEST_P(HonestClocks, SamePairsHoweverRun) {
  const auto frames = framesOf({"clustered", inputs::clustered}, 777, 4);
  const SceneInfo scene = sceneOf(frames);
  std::vector<std::vector<Pair>> expected;
  for (const Configuration& way : configurations(GetParam())) {
    SCOPED_TRACE(describe(GetParam(), way));
    Execution execution(way.threads, way.isa);
    try {
      Instance run(GetParam(), execution, scene, frames[0]);
      std::vector<std::vector<Pair>> answers;
      for (std::size_t i = 1; i < frames.size(); ++i)
        answers.push_back(sorted(run.step(frames[i])));
      if (expected.empty()) expected = answers;
      EXPECT_EQ(answers, expected);
    } catch (const UnsupportedError& error) {
      GTEST_SKIP() << error.what();
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Algorithms, HonestClocks, testing::ValuesIn(pairFinders()),
                         [](const auto& tested) { return testName(tested.param); });

TEST(SelfChecks, NoneFindsNothing) {
  const auto frames = framesOf({"identical", inputs::identical}, 10, 2);
  Execution execution(1, Isa::scalar);
  EXPECT_EQ(
      pairCount(
          Instance(algorithmOf("none"), execution, sceneOf(frames), frames[0]).step(frames[1])),
      0);
}

TEST(SelfChecks, TimeValidatorTakesItsTime) {
  const auto frames = framesOf({"identical", inputs::identical}, 10, 2);
  Execution execution(1, Isa::scalar);
  const std::unique_ptr<BroadPhase> validator = algorithmOf("time-validator").create();
  setParameters(*validator, {{"phase_us", "2000"}});
  validator->initialize(sceneOf(frames), {0, frames[0]}, execution);
  const FrameTimes times = runFrame(*validator, {1, frames[1]});
  std::int64_t sum = 0;
  for (const Phase phase : {Phase::update_objects, Phase::clean_cache, Phase::update_structures,
                            Phase::search_overlaps}) {
    EXPECT_GE(times[phase], 2'000'000) << phaseName(phase);
    sum += times[phase];
  }
  EXPECT_GE(times[Phase::total], sum);
}

}  // namespace
}  // namespace broadmark::tests
