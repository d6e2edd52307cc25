#include "inspector/session/opened_results.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "inspector/helpers.h"

namespace broadmark::tests {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

OpenedResults opened(std::vector<CaseResult> cases) {
  Results results;
  results.cases = std::move(cases);
  return OpenedResults("r.json", std::move(results), builtinAlgorithms());
}

std::vector<std::string> listed(const OpenedResults& results) {
  std::vector<std::string> ids;
  for (const std::size_t row : results.listed()) {
    ids.push_back(fmt::format("{} {}", results.rows()[row].result.algorithm,
                              results.rows()[row].result.recording.scene.objects));
  }
  return ids;
}

TEST(OpenedResults, AreListedAsInTheFileUntilTheyAreSorted) {
  OpenedResults results = opened({caseOf("sap", 1000, {{30, 30}}), caseOf("kd", 200, {{10, 50}}),
                                  caseOf("bf", 1000, {}), caseOf("kd", 1000, {{20, 20}})});
  EXPECT_THAT(listed(results), ElementsAre("sap 1000", "kd 200", "bf 1000", "kd 1000"));
  results.sort("seconds_per_frame", false);
  EXPECT_THAT(listed(results), ElementsAre("kd 1000", "sap 1000", "kd 200", "bf 1000"));
  results.sort("seconds_per_frame", true);
  EXPECT_THAT(listed(results), ElementsAre("sap 1000", "kd 200", "kd 1000", "bf 1000"));
  // Numerically, not alphabetically.
  results.sort("recording", false);
  EXPECT_THAT(listed(results), ElementsAre("kd 200", "sap 1000", "bf 1000", "kd 1000"));
  results.sort("variant", true);
  EXPECT_THAT(listed(results), ElementsAre("sap 1000", "kd 200", "kd 1000", "bf 1000"));
  results.sort("", false);
  EXPECT_THAT(listed(results), ElementsAre("sap 1000", "kd 200", "bf 1000", "kd 1000"));
}

TEST(OpenedResults, AreFiltered) {
  CaseResult wrong = caseOf("kd", 200, {{10}});
  // The same frame in two repetitions counts as one mismatch.
  wrong.differences.resize(2);
  for (FrameDifference& difference : wrong.differences) difference.frame = 1;
  OpenedResults results = opened({caseOf("sap", 1000, {{30}}), wrong, caseOf("kd", 1000, {{20}})});
  EXPECT_EQ(results.wrongCount(), 1U);
  EXPECT_EQ(results.rows()[1].mismatches, 1U);
  results.filter("kd", false);
  EXPECT_THAT(listed(results), ElementsAre("kd 200", "kd 1000"));
  results.filter("", true);
  EXPECT_THAT(listed(results), ElementsAre("kd 200"));
  results.filter("1000", true);
  EXPECT_THAT(listed(results), ElementsAre());
}

TEST(OpenedResults, TellOfAnAlgorithmWhatNoOtherColumnTells) {
  const OpenedResults results = opened({caseOf("kd", 200, {{10}})});
  EXPECT_EQ(results.rows()[0].algorithm, "kd/margin=0.5");
  EXPECT_EQ(results.rows()[0].recording, "Brownian/Cubes/N200/F3");
}

TEST(OpenedResults, PlotTheMedianOfTheRepetitions) {
  CaseResult result = caseOf("kd", 200, {{10, 40, 70}, {20, 50}, {60, 90}});
  result.differences.resize(1);
  result.differences[0].frame = 2;
  OpenedResults results = opened({result, caseOf("sap", 300, {{1}}), caseOf("bf", 200, {})});
  // By default, some cases of one recording that have times.
  ASSERT_EQ(results.curves(Phase::total).size(), 1U);
  const OpenedResults::Curve& curve = results.curves(Phase::total)[0];
  EXPECT_EQ(curve.row, 0U);
  EXPECT_TRUE(std::isnan(curve.seconds.at(0)));
  EXPECT_FLOAT_EQ(curve.seconds.at(1), 20e-9F);
  EXPECT_FLOAT_EQ(curve.seconds.at(2), 50e-9F);
  EXPECT_FLOAT_EQ(curve.seconds.at(3), 70e-9F);  // the others were interrupted
  EXPECT_EQ(curve.mismatches.at(2), 1);
  EXPECT_TRUE(std::isnan(curve.mismatches.at(1)));
  EXPECT_FLOAT_EQ(results.curves(Phase::upload)[0].seconds.at(1), 0);

  results.mark(1, true);
  results.mark(2, true);
  EXPECT_EQ(results.curves(Phase::total).size(), 2U);
  results.mark(0, false);
  ASSERT_EQ(results.curves(Phase::total).size(), 1U);
  EXPECT_EQ(results.curves(Phase::total)[0].row, 1U);
}

/// "kd: 200 1000" or "kd Brownian: 200 1000": a curve's name and sizes.
std::vector<std::string> scalingOf(OpenedResults& results, Phase phase = Phase::total) {
  std::vector<std::string> texts;
  for (const ScalingCurve& curve : results.scaling(phase)) {
    std::string& text = texts.emplace_back(curve.algorithm);
    if (!curve.scene.empty()) text += ' ' + curve.scene;
    text += ':';
    for (const ScalingCurve::Point& point : curve.points) text += fmt::format(" {}", point.objects);
  }
  return texts;
}

TEST(OpenedResults, PlotTheMeanOverNumbersOfBodies) {
  OpenedResults results =
      opened({caseOf("kd", 1000, {{30, 50}, {40}}), caseOf("sap", 100, {{1}}),
              caseOf("kd", 10, {{4}}), caseOf("kd", 100, {{10, 16}}), caseOf("bf", 100, {{9}})});
  // sap and bf have one size only.
  EXPECT_THAT(scalingOf(results), ElementsAre("kd/margin=0.5: 10 100 1000"));
  const ScalingCurve& curve = results.scaling(Phase::total)[0];
  EXPECT_DOUBLE_EQ(curve.points[1].seconds, 13e-9);
  EXPECT_DOUBLE_EQ(curve.points[2].seconds, 40e-9);
  EXPECT_EQ(curve.points[2].row, 0U);
  EXPECT_NEAR(curve.exponent, 0.5, 1e-12);  // 4 to 40 over two decades
  EXPECT_THAT(scalingOf(results, Phase::upload), ElementsAre());

  // The curves follow the list's filter, but not its order.
  results.sort("seconds_per_frame", false);
  EXPECT_THAT(scalingOf(results), ElementsAre("kd/margin=0.5: 10 100 1000"));
  results.filter("N100", false);
  EXPECT_THAT(scalingOf(results), ElementsAre("kd/margin=0.5: 100 1000"));
}

TEST(OpenedResults, PlotOverNumbersOfBodiesOnlyRightAndCompleteCases) {
  std::vector<CaseResult> cases;
  for (const std::uint32_t objects : {10U, 20U, 40U, 80U, 160U}) {
    cases.push_back(caseOf("kd", objects, {{objects}}));
  }
  cases[0].status = Status::mismatch;
  cases[1].conditions.repetitions = 2;  // interrupted
  cases[4].status = Status::timeout;
  OpenedResults results = opened(std::move(cases));
  EXPECT_THAT(scalingOf(results), ElementsAre("kd/margin=0.5: 40 80"));
}

TEST(OpenedResults, TellCurvesOverNumbersOfBodiesApart) {
  std::vector<CaseResult> cases;
  for (const std::uint32_t objects : {10U, 20U}) {
    cases.push_back(caseOf("kd", objects, {{objects}}));
    CaseResult& threaded = cases.emplace_back(caseOf("kd", objects, {{objects}}));
    threaded.threads = 3;
    threaded.id.replace(threaded.id.find("/t2/"), 4, "/t3/");
  }
  std::vector<CaseResult> scenes = {cases[0], cases[2]};
  OpenedResults threads = opened(std::move(cases));
  EXPECT_THAT(scalingOf(threads),
              ElementsAre("kd/t2/margin=0.5: 10 20", "kd/t3/margin=0.5: 10 20"));

  for (std::size_t i = 0; i < 2; ++i) {
    CaseResult& other = scenes.emplace_back(scenes[i]);
    other.recording.scene.name = "Gravity";
    other.id.replace(0, std::string("Brownian").size(), "Gravity");
  }
  OpenedResults two_scenes = opened(std::move(scenes));
  EXPECT_THAT(scalingOf(two_scenes), ElementsAre("kd/margin=0.5 Brownian/Cubes/F3: 10 20",
                                                 "kd/margin=0.5 Gravity/Cubes/F3: 10 20"));
}

TEST(OpenedResults, SayWhyACaseCannotBeOpened) {
  CaseResult gone = caseOf("kd", 200, {{10}});
  gone.recording.path = "no/such.aabbs";
  CaseResult foreign = caseOf("mine", 200, {{10}});
  foreign.plugin = "libmine.so";
  const OpenedResults results =
      opened({gone, foreign, caseOf("nobody", 200, {{10}}), caseOf("kd", 200, {{10}})});
  EXPECT_THAT(results.rows()[0].obstacle,
              HasSubstr("no/such.aabbs: the recording no longer exists"));
  EXPECT_THAT(results.rows()[1].obstacle, HasSubstr("--plugin libmine.so"));
  EXPECT_THAT(results.rows()[2].obstacle, HasSubstr("nobody"));
  EXPECT_EQ(results.rows()[3].obstacle, "");
}

}  // namespace
}  // namespace broadmark::tests
