// Merging the results of several runs.

#include "broadmark/results/merge.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace broadmark::tests {
namespace {

using testing::ElementsAre;
using testing::SizeIs;

CaseResult resultOf(const std::string& id, int repetitions, int requested) {
  CaseResult result;
  result.id = id;
  result.recording.hash = "hash";
  result.conditions.repetitions = requested;
  result.repetitions.resize(static_cast<std::size_t>(repetitions));
  return result;
}

Results runOf(const std::string& cpu, const std::string& started, std::vector<CaseResult> cases) {
  Results results;
  results.environments = {{.cpu = cpu, .started = started}};
  results.cases = std::move(cases);
  results.complete = true;
  return results;
}

std::vector<std::string> idsOf(const Results& results) {
  std::vector<std::string> ids;
  for (const CaseResult& result : results.cases) ids.push_back(result.id);
  return ids;
}

TEST(Merge, ShardsOfOneMachine) {
  const MergedResults merged = mergeResults(
      {runOf("a", "1", {resultOf("x", 1, 1)}), runOf("a", "2", {resultOf("y", 1, 1)})});
  EXPECT_THAT(idsOf(merged.results), ElementsAre("x", "y"));
  EXPECT_THAT(merged.results.environments, SizeIs(1));
  EXPECT_EQ(merged.repeated, 0U);
  EXPECT_TRUE(merged.results.complete);
}

TEST(Merge, MachinesStayApart) {
  const MergedResults merged = mergeResults(
      {runOf("a", "1", {resultOf("x", 1, 1)}), runOf("b", "1", {resultOf("x", 1, 1)})});
  EXPECT_THAT(idsOf(merged.results), ElementsAre("x", "x"));
  ASSERT_THAT(merged.results.environments, SizeIs(2));
  EXPECT_EQ(merged.results.cases[1].environment, 1U);
}

TEST(Merge, ACaseIsThereOnceAndRatherWhole) {
  Results broken = runOf("a", "2", {resultOf("x", 1, 3)});
  broken.complete = false;
  const MergedResults merged = mergeResults(
      {runOf("a", "1", {resultOf("x", 3, 3)}), broken, runOf("a", "3", {resultOf("y", 1, 3)})});
  EXPECT_THAT(idsOf(merged.results), ElementsAre("x", "y"));
  EXPECT_TRUE(merged.results.cases[0].isComplete());
  EXPECT_FALSE(merged.results.cases[1].isComplete());
  EXPECT_EQ(merged.repeated, 1U);
  EXPECT_FALSE(merged.results.complete);
}

TEST(Merge, OfNothingIsNothing) { EXPECT_THAT(mergeResults({}).results.cases, SizeIs(0)); }

}  // namespace
}  // namespace broadmark::tests
