// The ratio of two runs: its definition, and its rate of false claims.

#include "broadmark/analysis/run_ratio.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "engine/uneven_machine.h"

namespace broadmark::tests {
namespace {

std::int64_t nanoseconds(double seconds) { return std::llround(seconds * 1e9); }

/// A result with these seconds of its frames, for each pass.
CaseResult resultOf(const std::vector<std::vector<double>>& passes) {
  CaseResult result;
  for (const std::vector<double>& pass : passes) {
    Repetition& repetition = result.repetitions.emplace_back();
    for (const double seconds : pass) {
      repetition.frames.emplace_back()[Phase::total] = nanoseconds(seconds);
    }
  }
  return result;
}

std::optional<RunRatio> ratioOf(const std::vector<CaseResult>& before, const CaseResult& after) {
  PairedCase paired{.before = {}, .after = &after};
  for (const CaseResult& result : before) paired.before.push_back(&result);
  return ratiosOfRuns({&paired, 1}).front();
}
RunRatio ratioOf(const CaseResult& before, const CaseResult& after) {
  return ratioOf(std::vector{before}, after).value();
}

/// The ratios of the cases of two runs.
std::vector<RunRatio> ratiosOf(const std::vector<CaseResult>& before,
                               const std::vector<CaseResult>& after) {
  std::vector<PairedCase> cases;
  for (std::size_t i = 0; i < after.size(); ++i) cases.push_back({{&before[i]}, &after[i]});
  std::vector<RunRatio> ratios;
  for (const std::optional<RunRatio>& ratio : ratiosOfRuns(cases)) ratios.push_back(ratio.value());
  return ratios;
}

TEST(RunRatio, IsTheQuotientOfTheMeansOfLeastTimes) {
  const RunRatio ratio = ratioOf(resultOf({{1, 9}, {4, 3}}), resultOf({{2, 9}, {7, 6}}));
  EXPECT_DOUBLE_EQ(ratio.before, 2);
  EXPECT_DOUBLE_EQ(ratio.after, 4);
  EXPECT_DOUBLE_EQ(ratio.ratio.value, 2);
  EXPECT_FALSE(ratio.drift);
}

TEST(RunRatio, ManyPassesAreNoAdvantage) {
  // Two of three passes are drawn: the minimum is 1 in two of three draws, else 2.
  const RunRatio ratio = ratioOf(resultOf({{1}, {2}, {3}}), resultOf({{1}, {2}}));
  EXPECT_NEAR(ratio.before, 4.0 / 3, 1e-12);
  EXPECT_DOUBLE_EQ(ratio.after, 1);
}

TEST(RunRatio, NothingWithoutTimes) {
  const CaseResult none = resultOf({});
  const CaseResult empty = resultOf({{}});
  const CaseResult some = resultOf({{1}});
  for (const CaseResult& untimed : {none, empty}) {
    EXPECT_FALSE(ratioOf(std::vector{untimed}, some));
    EXPECT_FALSE(ratioOf(std::vector{some}, untimed));
  }
}

TEST(RunRatio, ClockTicksOfZeroStillHaveARatio) {
  const RunRatio ratio = ratioOf(resultOf({{0, 0}}), resultOf({{0, 0}}));
  EXPECT_DOUBLE_EQ(ratio.ratio.value, 1);
}

/// Two repetitions of 50 frames with this time; the second is slower by a thousandth.
CaseResult constant(double seconds) {
  return resultOf({std::vector<double>(50, seconds), std::vector<double>(50, seconds * 1.001)});
}

TEST(RunRatio, OfTheSameTimesIsOneWithoutAnInterval) {
  const Estimate ratio = ratioOf(resultOf({{1, 9}, {4, 3}}), resultOf({{1, 9}, {4, 3}})).ratio;
  EXPECT_EQ(ratio.value, 1);
  EXPECT_EQ(ratio.ci95.low, 1);
  EXPECT_EQ(ratio.ci95.high, 1);
}

TEST(RunRatio, IsRelativeToTheMedianOfTheOtherCases) {
  const std::vector<CaseResult> before(5, constant(1));
  const std::vector<RunRatio> ratios = ratiosOf(
      before, {constant(1.1), constant(1.1), constant(1.32), constant(1.1), constant(1.1)});
  EXPECT_NEAR(ratios[2].ratio.value, 1.2, 1e-6);
  EXPECT_NEAR(ratios[2].drift.value(), 0.1, 1e-6);
  EXPECT_GT(ratios[2].ratio.ci95.low, 1.19);
  for (const std::size_t other : {0U, 1U, 3U, 4U}) {
    EXPECT_NEAR(ratios[other].ratio.value, 1, 1e-6);
    EXPECT_NEAR(ratios[other].drift.value(), 0.1, 1e-6) << "not affected by the outlier";
  }
}

TEST(RunRatio, TheOtherCasesTellHowMuchRunsDiffer) {
  const std::vector<CaseResult> before(5, constant(1));
  const auto half = [&](double spread) {
    const RunRatio ratio =
        ratiosOf(before, {constant(1.0001), constant(1 + spread), constant(1 - spread),
                          constant(1 + 2 * spread), constant(1 - 2 * spread)})
            .front();
    return ratio.ratio.ci95.high - 1;
  };
  EXPECT_LT(half(0.002), 0.03);
  EXPECT_GT(half(0.02), 0.05);
}

TEST(RunRatio, TheDriftOfOneOtherCaseWidensTheInterval) {
  const RunRatio ratio =
      ratiosOf({constant(1), constant(1)}, {constant(1.001), constant(0.7)}).front();
  EXPECT_NEAR(ratio.ratio.value, 1.001, 1e-6);
  EXPECT_GT(ratio.ratio.ci95.high, 1 / 0.7);
  EXPECT_LT(ratio.ratio.ci95.low, 0.7);
}

TEST(RunRatio, CasesOnTheSameRecordingTellTheirDrift) {
  std::vector<CaseResult> before;
  std::vector<CaseResult> after;
  for (const auto& [recording, drift] : {std::pair{"a", 1.02}, {"b", 0.98}, {"c", 1.0}}) {
    for (int i = 0; i < 3; ++i) {
      before.push_back(constant(1));
      after.push_back(constant(drift));
      after.back().recording.hash = recording;
    }
  }
  for (const RunRatio& ratio : ratiosOf(before, after)) {
    EXPECT_NEAR(ratio.ratio.value, 1, 1e-6);
    EXPECT_LT(ratio.ratio.ci95.high, 1.01);
  }
}

TEST(RunRatio, IntervalsAreOfPositiveNumbers) {
  const std::vector<RunRatio> ratios =
      ratiosOf(std::vector<CaseResult>(4, resultOf({{1e-3}, {1e3}})),
               {resultOf({{1e-6}, {1e6}}), resultOf({{1}, {1e9}}), resultOf({{1e-9}, {1}}),
                resultOf({{1e3}, {1e-3}})});
  for (const RunRatio& ratio : ratios) {
    EXPECT_GT(ratio.ratio.ci95.low, 0);
    EXPECT_LE(ratio.ratio.ci95.low, ratio.ratio.value);
    EXPECT_GE(ratio.ratio.ci95.high, ratio.ratio.value);
  }
}

TEST(RunRatio, WithinARunOnlyItsOwnNoiseCounts) {
  const RunRatio ratio = ratioWithinRun(constant(1), constant(1.02)).value();
  EXPECT_NEAR(ratio.ratio.value, 1.02, 1e-6);
  EXPECT_GT(ratio.ratio.ci95.low, 1.01);
  EXPECT_FALSE(ratio.drift);
}

/// A case with `passes` of 100 frames, with different times, on an uneven machine.
CaseResult runOn(UnevenMachine& machine, double seconds, int passes) {
  CaseResult result;
  double own_noise = 0;
  for (int pass = 0; pass < passes; ++pass) {
    Repetition& repetition = result.repetitions.emplace_back();
    for (int frame = 0; frame < 100; ++frame) {
      const double work = seconds * (1 + 0.01 * frame);
      repetition.frames.emplace_back()[Phase::total] = nanoseconds(machine.time(work, own_noise));
    }
  }
  return result;
}

/// A run of twelve cases with five repetitions at this pace. In addition, a random factor of each
/// case models its memory layout.
std::vector<CaseResult> runOfTwelve(double pace, unsigned seed, double first_slower_by = 1) {
  UnevenMachine machine(seed, pace, 0, 0.001);
  std::mt19937 random(seed);
  std::normal_distribution<double> layout(0, 0.005);
  std::vector<CaseResult> cases;
  for (int i = 0; i < 12; ++i) {
    const double slower_by = i == 0 ? first_slower_by : 1;
    cases.push_back(runOn(machine, 1e-4 * slower_by * std::exp(layout(random)), 5));
  }
  return cases;
}

struct VerdictCounts {
  int same = 0;
  int claimed = 0;
};
/// Verdicts of 100 pairs of runs on their first case, on a machine with pace changes of a tenth.
VerdictCounts judgeFirst(double slower_by, double margin) {
  VerdictCounts counts;
  for (unsigned seed = 0; seed < 100; ++seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> pace(0, 0.1);
    const std::vector<CaseResult> before = runOfTwelve(std::exp(pace(random)), 2 * seed);
    const std::vector<CaseResult> after =
        runOfTwelve(std::exp(pace(random)), 2 * seed + 1, slower_by);
    const Verdict verdict = verdictOn(ratiosOf(before, after).front().ratio.ci95, margin);
    counts.same += verdict == Verdict::same ? 1 : 0;
    counts.claimed += verdict == Verdict::slower || verdict == Verdict::faster ? 1 : 0;
  }
  return counts;
}

TEST(RunRatio, DecidesWhatTwelveCasesOfTwoRunsAllow) {
  const VerdictCounts alike = judgeFirst(1, 0.05);
  EXPECT_GE(alike.same, 85);
  EXPECT_LE(alike.claimed, 5);
  EXPECT_LE(judgeFirst(1, 0).claimed, 5) << "of intervals without 1";
  EXPECT_GE(judgeFirst(1.1, 0.05).claimed, 90);
  EXPECT_GE(judgeFirst(1.05, 0.05).claimed, 60);
}

TEST(RunRatio, OneCaseAloneClaimsNoDifferenceWhereThereIsNone) {
  constexpr int kComparisons = 100;
  for (const double unsteadiness : {0.0, 0.01}) {
    for (const int passes : {1, 2, 5}) {
      int claimed = 0;
      for (unsigned seed = 0; seed < kComparisons; ++seed) {
        std::mt19937 random(seed);
        std::normal_distribution<double> pace(0, unsteadiness);
        UnevenMachine first(2 * seed, std::exp(pace(random)));
        UnevenMachine second(2 * seed + 1, std::exp(pace(random)));
        const CaseResult before = runOn(first, 1e-4, passes);
        const Interval ratio = ratioOf(before, runOn(second, 1e-4, passes)).ratio.ci95;
        claimed += ratio.low > 1 || ratio.high < 1 ? 1 : 0;
      }
      EXPECT_LE(claimed, kComparisons / 20) << unsteadiness << ", " << passes << " passes";
    }
  }
}

// Two runs of a case do not show the variance between runs on this machine.
TEST(RunRatio, FindsADifferenceOfTenPercentWithFiveBaselines) {
  constexpr int kComparisons = 100;
  int found = 0;
  int claimed = 0;
  for (unsigned seed = 0; seed < kComparisons; ++seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> pace(0, 0.005);
    unsigned number = 10 * seed;
    const auto run_case = [&](double seconds) {
      UnevenMachine machine(number++, std::exp(pace(random)), 0.0003);
      return runOn(machine, seconds, 10);
    };
    std::vector<CaseResult> baselines;
    for (int i = 0; i < 5; ++i) baselines.push_back(run_case(1e-4));
    found += ratioOf(baselines, run_case(1.1e-4))->ratio.ci95.low > 1 ? 1 : 0;
    const Interval same = ratioOf(baselines, run_case(1e-4))->ratio.ci95;
    claimed += same.low > 1 || same.high < 1 ? 1 : 0;
  }
  EXPECT_GE(found, kComparisons * 9 / 10);
  EXPECT_LE(claimed, kComparisons / 20);
}

TEST(RunRatio, ThreeBaselinesTellHowMuchRunsDiffer) {
  const CaseResult baseline = constant(1);
  const CaseResult slower = constant(1.1);
  const CaseResult faster = constant(0.9);
  const CaseResult judged = constant(1.1);
  EXPECT_LT(ratioOf({baseline, slower, faster}, judged)->ratio.ci95.low, 1);
  const CaseResult alike = constant(1.0001);
  EXPECT_LT(ratioOf(baseline, judged).ratio.ci95.low, 1.03) << "unknown with a single baseline";
  EXPECT_GT(ratioOf({baseline, alike, baseline}, judged)->ratio.ci95.low, 1.09);
}

}  // namespace
}  // namespace broadmark::tests
