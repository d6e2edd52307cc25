// Reported numbers of tests per body. An algorithm tests every pair that it reports, and each test
// counts for two bodies.

#include <gtest/gtest.h>

#include <numeric>
#include <string>

#include "algorithms/runs.h"
#include "support/changing_worlds.h"

namespace broadmark::tests {
namespace {

std::uint64_t sumOf(const std::vector<std::uint32_t>& counts) {
  return std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
}

/// The counts of a frame in which all bodies have moved: `tide` reports no tests in other frames.
std::vector<std::uint32_t> testCountsOf(const Algorithm& algorithm, const std::vector<Aabb>& boxes,
                                        const ParameterValues& parameters = {},
                                        Counters* counters = nullptr) {
  TestRun test_run(algorithm, {bestIsa(), 1}, parameters);
  test_run.start(inputs::uniform(boxes.size(), 2, 1));
  test_run.step(boxes);
  if (counters != nullptr) *counters = countersOf(test_run.broadPhase());
  return drawingOf(test_run.broadPhase(), boxes.size()).tests();
}

std::vector<std::uint32_t> testCountsOf(const std::string& id, const std::vector<Aabb>& boxes,
                                        const ParameterValues& parameters = {},
                                        Counters* counters = nullptr) {
  return testCountsOf(algorithmOf(id), boxes, parameters, counters);
}

class ToldTests : public testing::TestWithParam<Algorithm> {
 protected:
  void SetUp() override {
    const auto boxes = inputs::uniform(100, 1, 1);
    if (testCountsOf(GetParam(), boxes).empty()) GTEST_SKIP() << "reports no tests";
  }

  /// Checks all configurations, in the last frame.
  void check(const SceneInfo& scene, const std::vector<std::vector<Aabb>>& frames) {
    for (const Configuration& config : configurations(GetParam(), {1, 3})) {
      SCOPED_TRACE(describe(GetParam(), config));
      TestRun test_run(GetParam(), config);
      test_run.start(scene, frames.front());
      PairRuns answer;
      for (std::size_t i = 1; i < frames.size(); ++i) answer = test_run.step(frames[i]);
      const std::vector<std::uint32_t> tests =
          drawingOf(test_run.broadPhase(), scene.objects).tests();
      if (tests.empty() && pairCount(answer) == 0) continue;  // nothing to test
      ASSERT_EQ(tests.size(), scene.objects);
      EXPECT_EQ(sumOf(tests) % 2, 0U);
      EXPECT_GE(sumOf(tests), 2 * pairCount(answer));
      const std::vector<std::uint32_t> pairs = overlapCounts(scene.objects, answer);
      for (std::uint32_t body = 0; body < scene.objects; ++body) {
        ASSERT_GE(tests[body], pairs[body]) << "body " << body;
        if (isEmpty(frames.back()[body])) {
          ASSERT_EQ(tests[body], 0U) << "of an absent body";
        }
      }
    }
  }
};

TEST_P(ToldTests, AreAsManyAsThePairsOrMore) {
  for (const inputs::Input& input : {inputs::Input{"drifting", inputs::drifting},
                                     {"assorted", inputs::assorted},
                                     {"clustered", inputs::clustered}}) {
    SCOPED_TRACE(input.name);
    const auto frames = framesOf(input, 3000, 4);
    check(sceneOf(frames), frames);
  }
}

TEST_P(ToldTests, AreOfTheSceneWhereBodiesComeAndGo) {
  for (const NamedFilter& filter : filters(400)) {
    SCOPED_TRACE(filter.name);
    const auto frames =
        framesWith({"drifting", inputs::drifting}, 400, 4,
                   [](std::uint32_t body, std::uint32_t frame) { return (body + frame) % 5 != 0; });
    SceneInfo scene = sceneOf(frames);
    scene.all_present = false;
    scene.filter = filter.filter;
    check(scene, frames);
  }
}

INSTANTIATE_TEST_SUITE_P(Listed, ToldTests, testing::ValuesIn(pairFinders()),
                         [](const auto& tested) { return testName(tested.param); });

TEST(ToldTestsOf, BruteForceAreOfEveryOtherBody) {
  const std::vector<std::uint32_t> all_others(100, 99);
  const std::vector<Aabb> boxes = inputs::uniform(100, 1, 1);
  for (const char* id : {"bf", "bf-simd"}) EXPECT_EQ(testCountsOf(id, boxes), all_others) << id;
  // As in a single cell.
  EXPECT_EQ(testCountsOf("grid-bf", boxes, {{"objects_per_cell", "1000"}}), all_others);
  EXPECT_EQ(testCountsOf("grid2d-bf", boxes, {{"objects_per_cell", "1000"}}), all_others);
}

TEST(ToldTestsOf, ASweepAreOfWhatOverlapsOnItsAxis) {
  std::vector<Aabb> boxes = inputs::uniform(300, 1, 1);
  for (Aabb& box : boxes) {  // the z axis is by far the longest
    box.min[2] *= 10;
    box.max[2] *= 10;
  }
  std::vector<std::uint32_t> expected(boxes.size());
  for (std::size_t a = 0; a < boxes.size(); ++a) {
    for (std::size_t b = 0; b < boxes.size(); ++b) {
      const bool overlap = boxes[a].min[2] <= boxes[b].max[2] && boxes[b].min[2] <= boxes[a].max[2];
      expected[a] += a != b && overlap ? 1 : 0;
    }
  }
  EXPECT_EQ(testCountsOf("sap", boxes), expected);
  EXPECT_EQ(testCountsOf("sap-simd", boxes), expected);
}

TEST(ToldTestsOf, ColumnsAreThoseThatTheFrameCounted) {
  Counters counters;
  const auto tests = testCountsOf("columns", inputs::clustered(5000, 1, 1), {}, &counters);
  EXPECT_EQ(sumOf(tests), 2 * counters.at("tests"));
}

TEST(ToldTestsOf, GridsAndTideAreKnown) {
  for (const char* id : {"grid-sap", "tide"}) {
    EXPECT_FALSE(testCountsOf(id, inputs::uniform(100, 1, 1)).empty()) << id;
  }
}

}  // namespace
}  // namespace broadmark::tests
