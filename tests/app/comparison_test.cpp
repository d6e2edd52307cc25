// Two runs case by case: what is faster, slower, a regression, or not comparable.

#include "comparison.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/helpers.h"

namespace broadmark::tests {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

/// A result with frames that take about `ns`, in so many repetitions.
CaseResult resultOf(const std::string& id, std::int64_t ns, int repetitions = 1,
                    std::size_t frames = 200) {
  CaseResult result;
  result.id = id;
  result.recording.hash = "hash";
  for (int r = 0; r < repetitions; ++r) {
    Repetition& repetition = result.repetitions.emplace_back();
    for (std::size_t i = 0; i < frames; ++i) {
      FrameTimes& times = repetition.frames.emplace_back();
      // A little noise: without any there is no interval.
      times[Phase::total] = ns + static_cast<std::int64_t>((i * 7 + 3U * r) % 11) * ns / 1000;
    }
  }
  return result;
}

CaseResult withStatus(CaseResult result, Status status) {
  result.status = status;
  return result;
}

Results resultsOf(std::vector<CaseResult> cases) {
  return {.environments = {{}}, .options = {}, .cases = std::move(cases)};
}

/// The verdict on one case in both runs.
Verdict verdictOn(const CaseResult& before, const CaseResult& after, double fail_above = 0.05) {
  const Comparison comparison = compareResults(resultsOf({before}), resultsOf({after}), fail_above);
  EXPECT_EQ(comparison.cases.size(), 1U);
  EXPECT_EQ(comparison.regressed(), comparison.cases.front().verdict == Verdict::regressed);
  return comparison.cases.front().verdict;
}

std::vector<Verdict> verdictsOf(const Comparison& comparison) {
  std::vector<Verdict> verdicts;
  for (const CaseComparison& compared : comparison.cases) verdicts.push_back(compared.verdict);
  return verdicts;
}

TEST(Compare, WithItselfIsTheSame) {
  for (const int repetitions : {1, 5}) {
    const CaseResult result = resultOf("a", 1'000'000, repetitions);
    EXPECT_EQ(verdictOn(result, result), Verdict::same);
    const Results results = resultsOf({result});
    EXPECT_EQ(compareResults(results, results, 0.05).cases.front().ratio->ratio, 1);
  }
}

TEST(Compare, TimesDecide) {
  for (const int repetitions : {1, 5}) {
    const CaseResult normal = resultOf("a", 1'000'000, repetitions);
    EXPECT_EQ(verdictOn(normal, resultOf("a", 1'500'000, repetitions)), Verdict::regressed);
    EXPECT_EQ(verdictOn(normal, resultOf("a", 1'030'000, repetitions)), Verdict::slower);
    EXPECT_EQ(verdictOn(normal, resultOf("a", 700'000, repetitions)), Verdict::faster);
  }
}

TEST(Compare, FailAboveIsWhatIsTolerated) {
  const CaseResult before = resultOf("a", 1'000'000);
  const CaseResult after = resultOf("a", 1'500'000);
  EXPECT_EQ(verdictOn(before, after, 0.4), Verdict::regressed);
  EXPECT_EQ(verdictOn(before, after, 0.6), Verdict::slower);
  EXPECT_EQ(verdictOn(before, resultOf("a", 1'010'000), 0), Verdict::regressed);
}

TEST(Compare, TheRatioIsThatOfTheMeans) {
  const Comparison comparison = compareResults(resultsOf({resultOf("a", 1'000'000)}),
                                               resultsOf({resultOf("a", 2'000'000)}), 0.05);
  const CaseComparison& compared = comparison.cases.front();
  EXPECT_NEAR(compared.ratio->ratio, 2, 1e-6);
  EXPECT_NEAR(compared.after / compared.before, 2, 1e-6);
  ASSERT_TRUE(compared.ratio->ci95);
  EXPECT_LE(compared.ratio->ci95->low, 2);
  EXPECT_GE(compared.ratio->ci95->high, 2);
}

TEST(Compare, ALostOkIsARegression) {
  const CaseResult ok = resultOf("a", 1'000'000);
  for (const Status status :
       {Status::mismatch, Status::timeout, Status::unsupported, Status::error}) {
    EXPECT_EQ(verdictOn(ok, withStatus(ok, status)), Verdict::regressed);
    EXPECT_EQ(verdictOn(withStatus(ok, status), ok), Verdict::other_status);
    EXPECT_EQ(verdictOn(withStatus(ok, status), withStatus(ok, status)), Verdict::not_ok);
  }
  EXPECT_EQ(verdictOn(withStatus(ok, Status::timeout), withStatus(ok, Status::mismatch)),
            Verdict::other_status);
}

TEST(Compare, CasesWithoutTimesAreNotTimed) {
  CaseResult untimed = resultOf("a", 1);
  untimed.repetitions.clear();
  EXPECT_EQ(verdictOn(untimed, untimed), Verdict::not_timed);
  EXPECT_EQ(verdictOn(untimed, resultOf("a", 1'000'000)), Verdict::not_timed);
}

TEST(Compare, OtherRecordingsAreNotComparable) {
  CaseResult other = resultOf("a", 9'000'000);
  other.recording.hash = "other";
  const Results before = resultsOf({resultOf("a", 1'000'000), resultOf("b", 1'000'000)});
  const Comparison partly =
      compareResults(before, resultsOf({other, resultOf("b", 1'000'000)}), 0.05);
  EXPECT_THAT(verdictsOf(partly), ElementsAre(Verdict::other_recording, Verdict::same));
  EXPECT_FALSE(partly.regressed());
  EXPECT_TRUE(partly.comparable());
  EXPECT_FALSE(compareResults(before, resultsOf({other}), 0.05).comparable());
}

TEST(Compare, CasesOfOneRunOnly) {
  const Comparison comparison =
      compareResults(resultsOf({resultOf("gone", 1), resultOf("both", 1)}),
                     resultsOf({resultOf("new", 1), resultOf("both", 1)}), 0.05);
  EXPECT_THAT(verdictsOf(comparison),
              ElementsAre(Verdict::only_after, Verdict::same, Verdict::only_before));
  EXPECT_EQ(comparison.cases.front().id, "new");
  EXPECT_EQ(comparison.cases.back().id, "gone");
  EXPECT_FALSE(compareResults(resultsOf({}), resultsOf({}), 0.05).comparable());
}

TEST(Compare, CasesOfOneIdAreTakenInTurn) {
  const Results twice = resultsOf({resultOf("a", 1'000'000), resultOf("a", 9'000'000)});
  EXPECT_THAT(verdictsOf(compareResults(twice, twice, 0.05)),
              ElementsAre(Verdict::same, Verdict::same));
  const Results thrice =
      resultsOf({resultOf("a", 1'000'000), resultOf("a", 9'000'000), resultOf("a", 1)});
  EXPECT_THAT(verdictsOf(compareResults(twice, thrice, 0.05)),
              ElementsAre(Verdict::same, Verdict::same, Verdict::only_after));
}

TEST(Compare, TheTableTellsEachVerdict) {
  const CaseResult ok = resultOf("wrong now", 1'000'000);
  const std::string table = formatComparison(compareResults(
      resultsOf({ok, resultOf("gone", 1), withStatus(resultOf("late", 1), Status::timeout)}),
      resultsOf({withStatus(ok, Status::mismatch), withStatus(resultOf("late", 1), Status::timeout),
                 resultOf("new", 1)}),
      0.05));
  for (const char* text :
       {"ok -> mismatch REGRESSED", "only in A", "only in B", "timeout in both"}) {
    EXPECT_THAT(table, HasSubstr(text));
  }
  EXPECT_THAT(table, Not(HasSubstr("faster")));
}

}  // namespace
}  // namespace broadmark::tests
