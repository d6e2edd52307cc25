// Instructions instead of times: requests, results and verdicts.

#include "request/count.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadmark/results/results.h"
#include "compare/comparison.h"
#include "engine/helpers.h"
#include "request/run_request.h"
#include "support/table.h"

namespace broadmark::tests {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

constexpr std::size_t kFrames = 10;

/// A case with this number of instructions in each repetition of ten frames.
CaseResult countedCase(std::uint64_t instructions, CounterSource source = CounterSource::valgrind) {
  CaseResult result;
  result.id = "Scene/Cubes/N2/F10/sap";
  result.algorithm = "sap";
  result.recording.hash = "hash";
  result.conditions.counted_by = source;
  result.conditions.repetitions = 1;
  result.frames.resize(kFrames);
  result.repetitions.emplace_back().processor[ProcessorCounter::instructions] = instructions;
  return result;
}

Results resultsOfCase(CaseResult result) {
  return {.environments = {{}}, .options = {}, .cases = {std::move(result)}, .complete = true};
}

std::string jsonOfCase(const CaseResult& result) {
  for (const ResultWriter& writer : resultWriters()) {
    if (writer.name == "json") return writer.format(resultsOfCase(result));
  }
  return {};
}

Comparison compareCounts(const CaseResult& before, const CaseResult& after) {
  const std::vector<NamedResults> runs = {{"a.json", resultsOfCase(before)}};
  return compareResults(runs, {"b.json", resultsOfCase(after)},
                        {.margin = kCountMargin, .instructions = true});
}

Verdict verdictOnCounts(const CaseResult& before, const CaseResult& after) {
  return compareCounts(before, after).cases.at(0).verdict;
}

TEST(Count, OptionHasANumberOfFrames) {
  EXPECT_EQ(parseCount("instructions").frames, 10U);
  EXPECT_EQ(parseCount("instructions:3").frames, 3U);
  for (const char* text : {"instructions", "instructions:3"}) {
    EXPECT_TRUE(parseCount(text).instructions);
    EXPECT_EQ(countText(parseCount(text)), text);
  }
  EXPECT_EQ(countText({}), "");
  for (const char* text : {"", "time", "instructions:", "instructions:0", "instructions:1:2"}) {
    EXPECT_THAT(inputErrorOf([&] { parseCount(text); }), HasSubstr("--count")) << text;
  }
}

TEST(Count, RunsOneThreadAndFewFrames) {
  RunRequest request{.count = {.instructions = true, .frames = 3}};
  prepareCount(request);
  EXPECT_TRUE(request.policy.counted_by);
  EXPECT_EQ(request.policy.max_frames, 3U);
  EXPECT_THAT(request.cases.threads, ElementsAre(1));
  ASSERT_EQ(request.cases.isas.size(), 1U);
  if (request.hosts.valgrind) {
    EXPECT_NE(request.cases.isas.front(), Isa::avx512);
  }
  RunRequest timed;
  prepareCount(timed);
  EXPECT_FALSE(timed.policy.counted_by);
  EXPECT_TRUE(timed.cases.threads.empty());
}

TEST(Count, RefusesWhatCannotBeCounted) {
  RunRequest request{.count = {.instructions = true}};
  request.repetitions.until_precise = true;
  EXPECT_THAT(inputErrorOf([&] { prepareCount(request); }), HasSubstr("--repetitions auto"));
  const Case threads = caseNamed("kd-mt/t2", "");
  EXPECT_THAT(inputErrorOf([&] { requireOneThread({threads}); }),
              testing::AllOf(HasSubstr("kd-mt/"), HasSubstr("--threads 1")));
}

TEST(Count, MeanPerFrameWithoutTimes) {
  const CaseResult result = countedCase(50);
  EXPECT_EQ(result.perFrame(ProcessorCounter::instructions), 5);
  const Results back = parseResults(jsonOfCase(result), "results");
  const CaseResult& read = back.cases.at(0);
  EXPECT_EQ(read.conditions.counted_by, CounterSource::valgrind);
  EXPECT_EQ(read.perFrame(ProcessorCounter::instructions), 5);
  EXPECT_TRUE(read.repetitions.at(0).frames.empty());
  const std::string json = jsonOfCase(result);
  EXPECT_THAT(json, HasSubstr("\"seconds_per_frame\": null"));
  EXPECT_THAT(json, HasSubstr("\"counted_by\": \"valgrind\""));
}

TEST(Count, TableShowsInstructionsInsteadOfTimes) {
  const std::vector<CaseResult> results = {countedCase(50)};
  const std::string table = formatTable(results);
  EXPECT_THAT(table, HasSubstr("instructions per frame"));
  EXPECT_THAT(table, Not(HasSubstr("median")));
}

TEST(Count, ADifferenceBeyondTheToleranceIsClaimed) {
  const CaseResult before = countedCase(1'000'000);
  EXPECT_EQ(verdictOnCounts(before, before), Verdict::same);
  EXPECT_EQ(verdictOnCounts(before, countedCase(1'000'900)), Verdict::same);
  EXPECT_EQ(verdictOnCounts(before, countedCase(999'100)), Verdict::same);
  EXPECT_EQ(verdictOnCounts(before, countedCase(1'001'100)), Verdict::slower);
  EXPECT_EQ(verdictOnCounts(before, countedCase(998'000)), Verdict::faster);
  const Comparison worse = compareCounts(before, countedCase(1'060'000));
  EXPECT_EQ(worse.cases.at(0).verdict, Verdict::regressed);
  EXPECT_EQ(worse.exitStatus(), 3);
  EXPECT_THAT(formatComparison(worse), HasSubstr("106000"));
  const ComparisonOptions strict{.fail_above = 0, .margin = 0, .instructions = true};
  EXPECT_EQ(compareInstructions(before, before, strict).verdict, Verdict::same);
  EXPECT_EQ(compareInstructions(before, countedCase(1'002'000), strict).verdict,
            Verdict::regressed);
}

TEST(Count, CountsOfDifferentOriginAreNotCompared) {
  const CaseResult before = countedCase(1'000);
  const Comparison comparison = compareCounts(before, countedCase(1'000, CounterSource::processor));
  EXPECT_EQ(comparison.cases.at(0).verdict, Verdict::other_conditions);
  EXPECT_FALSE(comparison.comparable());
  EXPECT_THAT(formatComparison(comparison),
              HasSubstr("instructions counted by: valgrind -> processor"));
  CaseResult longer = before;
  longer.frames.resize(2 * kFrames);
  EXPECT_EQ(verdictOnCounts(before, longer), Verdict::other_conditions);
}

TEST(Count, CompareWithoutTheOptionNamesIt) {
  const std::vector<NamedResults> runs = {{"a.json", resultsOfCase(countedCase(1))}};
  const Comparison comparison = compareResults(runs, {"b.json", resultsOfCase(countedCase(1))}, {});
  EXPECT_EQ(comparison.cases.at(0).verdict, Verdict::not_timed);
  EXPECT_THAT(formatComparison(comparison), HasSubstr("--count instructions"));
}

}  // namespace
}  // namespace broadmark::tests
