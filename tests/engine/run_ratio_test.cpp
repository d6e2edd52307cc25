// The ratio of two runs: what it is of, and how often it claims what is not so.

#include "broadmark/analysis/run_ratio.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "engine/uneven_machine.h"

namespace broadmark::tests {
namespace {

std::int64_t nanoseconds(double seconds) { return std::llround(seconds * 1e9); }

/// A result whose frames take these seconds, pass by pass.
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

/// A case in a run of nothing else.
CaseInRun inRun(const CaseResult& result) {
  Results run;
  run.cases = {result};
  return {.result = &result, .pace = paceOf(run, result.recording.hash)};
}

std::optional<RunRatio> ratioOf(const std::vector<CaseResult>& before, const CaseResult& after) {
  std::vector<CaseInRun> runs;
  for (const CaseResult& run : before) runs.push_back(inRun(run));
  return ratioOfRuns(runs, inRun(after));
}
RunRatio ratioOf(const CaseResult& before, const CaseResult& after) {
  return ratioOf(std::vector{before}, after).value();
}

TEST(RunRatio, IsTheQuotientOfTheMeansOfLeastTimes) {
  const RunRatio ratio = ratioOf(resultOf({{1, 9}, {4, 3}}), resultOf({{2, 9}, {7, 6}}));
  EXPECT_DOUBLE_EQ(ratio.before, 2);
  EXPECT_DOUBLE_EQ(ratio.after, 4);
  EXPECT_DOUBLE_EQ(ratio.ratio.value, 2);
  EXPECT_FALSE(ratio.drift);
}

TEST(RunRatio, ManyPassesAreNoAdvantage) {
  // Of three passes two are drawn: the least is 1 in two of three draws, else 2.
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

TEST(RunRatio, ThePaceIsTheLeastOfAllCasesThatTookTurns) {
  CaseResult one = resultOf({{1}, {1}});
  one.repetitions[0].yardsticks = {{5, 9}};
  one.repetitions[1].yardsticks = {{7, 8}};
  CaseResult other = one;
  other.repetitions[1].yardsticks = {{6, 3}};
  CaseResult elsewhere = one;
  elsewhere.recording.hash = "elsewhere";
  elsewhere.repetitions[0].yardsticks = {{1, 1}};
  Results run;
  run.cases = {one, other, elsewhere};
  const std::optional<YardstickTimes> pace = paceOf(run, "");
  ASSERT_TRUE(pace);
  EXPECT_EQ(pace->values, (YardstickTimes{{5, 3}}.values));
  run.cases = {resultOf({{1}})};
  EXPECT_FALSE(paceOf(run, ""));
}

TEST(RunRatio, DriftWidensTheIntervalAndMovesNothing) {
  CaseResult before = resultOf({std::vector<double>(50, 1.0), std::vector<double>(50, 1.001)});
  CaseResult after = before;
  const Interval calm = ratioOf(before, after).ratio.ci95;
  for (Repetition& repetition : before.repetitions) repetition.yardsticks = {{1000, 1000}};
  for (Repetition& repetition : after.repetitions) repetition.yardsticks = {{1010, 1100}};
  const RunRatio drifted = ratioOf(before, after);
  EXPECT_DOUBLE_EQ(drifted.ratio.value, 1);
  ASSERT_TRUE(drifted.drift);
  EXPECT_NEAR(*drifted.drift, 0.1, 1e-9);
  EXPECT_NEAR(drifted.ratio.ci95.high, calm.high * 1.1, 1e-9);
  EXPECT_NEAR(drifted.ratio.ci95.low, calm.low / 1.1, 1e-9);
}

/// A run of so many passes of 100 frames, of different lengths, on an uneven machine.
CaseResult runOn(UnevenMachine machine, double seconds, int passes) {
  CaseResult result;
  double own_noise = 0;
  for (int pass = 0; pass < passes; ++pass) {
    Repetition& repetition = result.repetitions.emplace_back();
    YardstickTimes& yardsticks = repetition.yardsticks.emplace();
    for (std::int64_t& ns : yardsticks.values) ns = nanoseconds(machine.yardstick(1e-3));
    for (int frame = 0; frame < 100; ++frame) {
      const double work = seconds * (1 + 0.01 * frame);
      repetition.frames.emplace_back()[Phase::total] = nanoseconds(machine.time(work, own_noise));
    }
  }
  return result;
}

/// Whether two runs, at paces that differ by `unsteadiness` and then wander, claim that one is
/// slower or faster.
bool claims(double slower_by, double unsteadiness, double wander, int passes, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> pace(0, unsteadiness);
  const double paces[] = {std::exp(pace(random)), std::exp(pace(random))};
  const CaseResult before = runOn(UnevenMachine(2 * seed, paces[0], wander), 1e-4, passes);
  const CaseResult after =
      runOn(UnevenMachine(2 * seed + 1, paces[1], wander), 1e-4 * slower_by, passes);
  const Interval ratio = ratioOf(before, after).ratio.ci95;
  return ratio.low > 1 || ratio.high < 1;
}

TEST(RunRatio, ClaimsNoDifferenceWhereThereIsNone) {
  constexpr int kComparisons = 100;
  for (const double unsteadiness : {0.0, 0.1}) {
    for (const int passes : {1, 2, 5}) {
      int claimed = 0;
      for (unsigned seed = 0; seed < kComparisons; ++seed) {
        claimed += claims(1, unsteadiness, 0.002, passes, seed) ? 1 : 0;
      }
      EXPECT_LE(claimed, kComparisons / 20) << unsteadiness << ", " << passes << " passes";
    }
  }
}

// Two runs alone tell no such difference: nobody knows how much runs differ on this machine.
TEST(RunRatio, FindsADifferenceOfTenPercentWithFiveBaselines) {
  constexpr int kComparisons = 100;
  int found = 0;
  int claimed = 0;
  for (unsigned seed = 0; seed < kComparisons; ++seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> pace(0, 0.005);
    unsigned number = 10 * seed;
    const auto run = [&](double seconds) {
      return runOn(UnevenMachine(number++, std::exp(pace(random)), 0.0003), seconds, 10);
    };
    std::vector<CaseResult> baselines;
    for (int i = 0; i < 5; ++i) baselines.push_back(run(1e-4));
    found += ratioOf(baselines, run(1.1e-4))->ratio.ci95.low > 1 ? 1 : 0;
    const Interval same = ratioOf(baselines, run(1e-4))->ratio.ci95;
    claimed += same.low > 1 || same.high < 1 ? 1 : 0;
  }
  EXPECT_GE(found, kComparisons * 9 / 10);
  EXPECT_LE(claimed, kComparisons / 20);
}

TEST(RunRatio, ThreeBaselinesTellHowMuchRunsDiffer) {
  const auto constant = [](double seconds) {
    return resultOf({std::vector<double>(50, seconds), std::vector<double>(50, seconds * 1.0001)});
  };
  const CaseResult one = constant(1);
  const CaseResult two = constant(1.1);
  const CaseResult three = constant(0.9);
  const CaseResult judged = constant(1.1);
  EXPECT_LT(ratioOf({one, two, three}, judged)->ratio.ci95.low, 1);
  const CaseResult alike = constant(1.0001);
  EXPECT_LT(ratioOf(one, judged).ratio.ci95.low, 1.03) << "nobody knows";
  EXPECT_GT(ratioOf({one, alike, one}, judged)->ratio.ci95.low, 1.09);
}

}  // namespace
}  // namespace broadmark::tests
