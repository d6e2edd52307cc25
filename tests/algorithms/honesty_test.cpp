// Requirements for comparable times: the answer is the algorithm's own, complete when the search
// returns, and the same in every configuration.

#include <gtest/gtest.h>

#include <numeric>

#include "algorithms/runs.h"

namespace broadmark::tests {
namespace {

/// Overwrites all boxes in place by unrelated boxes.
void scramble(std::vector<Aabb>& boxes) {
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const auto x = static_cast<float>(i % 3);
    boxes[i] = {{x, x, x, 0}, {x + 1, x + 1, x + 1, 0}};
  }
}

/// The pairs; or the pairs that began, and the pairs that ended.
std::vector<std::vector<Pair>> answerOf(const BroadPhase& algorithm, AnswerKind kind) {
  if (kind == AnswerKind::pairs) return {sorted(algorithm.overlaps())};
  return {sorted(algorithm.events().began), sorted(algorithm.events().ended)};
}

class HonestClocks : public testing::TestWithParam<Algorithm> {};

// Fails if an algorithm reads the caller's boxes after updateObjects, or computes in overlaps().
TEST_P(HonestClocks, AnswerDoesNotDependOnBoxesAfterwards) {
  const auto frames = framesOf({"assorted", inputs::assorted}, 500, 4);
  const SceneInfo scene = sceneOf(frames);
  for (const Configuration& config : allConfigurations(GetParam())) {
    SCOPED_TRACE(describe(GetParam(), config));
    TestRun test_run(GetParam(), config);
    try {
      test_run.start(scene, frames[0]);
      for (std::size_t i = 1; i < frames.size(); ++i) test_run.step(frames[i]);
      const std::vector<std::vector<Pair>> undisturbed =
          answerOf(test_run.broadPhase(), config.answer);
      ASSERT_FALSE(undisturbed.front().empty());

      std::vector<Aabb> boxes = frames[0];
      test_run.start(scene, boxes);
      scramble(boxes);
      std::vector<std::uint32_t> all(boxes.size());
      std::iota(all.begin(), all.end(), 0U);
      BroadPhase& algorithm = test_run.broadPhase();
      for (std::uint32_t i = 1; i < frames.size(); ++i) {
        boxes = frames[i];
        algorithm.updateObjects({i, boxes, all});
        scramble(boxes);
        algorithm.cleanCache();
        algorithm.updateStructures();
        algorithm.searchOverlaps();
        scramble(boxes);
      }
      EXPECT_EQ(answerOf(algorithm, config.answer), undisturbed);
    } catch (const UnsupportedError& error) {
      GTEST_SKIP() << error.what();
    }
  }
}

TEST_P(HonestClocks, SamePairsHoweverRun) {
  const auto frames = framesOf({"clustered", inputs::clustered}, 777, 4);
  const SceneInfo scene = sceneOf(frames);
  std::vector<std::vector<Pair>> expected;
  for (const Configuration& config : allConfigurations(GetParam())) {
    SCOPED_TRACE(describe(GetParam(), config));
    TestRun test_run(GetParam(), config);
    try {
      test_run.start(scene, frames[0]);
      std::vector<std::vector<Pair>> answers;
      for (std::size_t i = 1; i < frames.size(); ++i)
        answers.push_back(sorted(test_run.step(frames[i])));
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
  TestRun test_run(algorithmOf("none"));
  test_run.start(frames[0]);
  EXPECT_EQ(pairCount(test_run.step(frames[1])), 0U);
}

TEST(SelfChecks, TimeValidatorTakesItsTime) {
  const auto frames = framesOf({"identical", inputs::identical}, 10, 2);
  TestRun test_run(algorithmOf("time-validator"), {}, {{"phase_us", "2000"}});
  test_run.start(frames[0]).step(frames[1]);
  std::int64_t sum = 0;
  for (const Phase phase : {Phase::update_objects, Phase::clean_cache, Phase::update_structures,
                            Phase::search_overlaps}) {
    EXPECT_GE(test_run.times()[phase], 2'000'000) << kPhases.nameOf(phase);
    sum += test_run.times()[phase];
  }
  EXPECT_GE(test_run.times()[Phase::total], sum);
}

}  // namespace
}  // namespace broadmark::tests
