#include "inspector/opened_results.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "inspector/helpers.h"

namespace broadmark::tests {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// A case whose frames took so many nanoseconds, a list for each repetition.
CaseResult caseOf(const std::string& algorithm, std::uint32_t objects,
                  const std::vector<std::vector<std::int64_t>>& repetitions) {
  CaseResult result;
  result.algorithm = algorithm;
  result.recording.scene.name = "Brownian";
  result.recording.scene.object_type = "Cubes";
  result.recording.scene.objects = objects;
  result.recording.scene.frames = 3;
  result.id = fmt::format("Brownian/Cubes/N{}/F3/{}/t2/margin=0.5", objects, algorithm);
  result.threads = 2;
  for (const auto& times : repetitions) {
    Repetition& repetition = result.repetitions.emplace_back();
    for (const std::int64_t ns : times) {
      repetition.frames.emplace_back()[Phase::total] = ns;
    }
  }
  return result;
}

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
  results.sort(CaseColumn::mean, false);
  EXPECT_THAT(listed(results), ElementsAre("kd 1000", "sap 1000", "kd 200", "bf 1000"));
  results.sort(CaseColumn::mean, true);
  EXPECT_THAT(listed(results), ElementsAre("sap 1000", "kd 200", "kd 1000", "bf 1000"));
  // By size, not by letters.
  results.sort(CaseColumn::recording, false);
  EXPECT_THAT(listed(results), ElementsAre("kd 200", "sap 1000", "bf 1000", "kd 1000"));
  results.sort(CaseColumn::algorithm, true);
  EXPECT_THAT(listed(results), ElementsAre("sap 1000", "kd 200", "kd 1000", "bf 1000"));
  results.sort({}, false);
  EXPECT_THAT(listed(results), ElementsAre("sap 1000", "kd 200", "bf 1000", "kd 1000"));
}

TEST(OpenedResults, AreFiltered) {
  CaseResult wrong = caseOf("kd", 200, {{10}});
  // The same frame in two repetitions is one mismatch.
  wrong.differences.resize(2);
  for (FrameDifference& difference : wrong.differences) difference.frame = 1;
  OpenedResults results = opened({caseOf("sap", 1000, {{30}}), wrong, caseOf("kd", 1000, {{20}})});
  EXPECT_EQ(results.wrong(), 1U);
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
  // At first some of one recording, as far as there are times.
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

TEST(OpenedResults, SayWhyACaseCannotBeOpened) {
  CaseResult gone = caseOf("kd", 200, {{10}});
  gone.recording.path = "no/such.aabbs";
  CaseResult foreign = caseOf("mine", 200, {{10}});
  foreign.plugin = "libmine.so";
  const OpenedResults results =
      opened({gone, foreign, caseOf("nobody", 200, {{10}}), caseOf("kd", 200, {{10}})});
  EXPECT_THAT(results.rows()[0].obstacle, HasSubstr("no/such.aabbs: no such recording"));
  EXPECT_THAT(results.rows()[1].obstacle, HasSubstr("--plugin libmine.so"));
  EXPECT_THAT(results.rows()[2].obstacle, HasSubstr("nobody"));
  EXPECT_EQ(results.rows()[3].obstacle, "");
}

}  // namespace
}  // namespace broadmark::tests
