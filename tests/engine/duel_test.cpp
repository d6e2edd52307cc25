// Duels: their statistics on simulated machines with realistic noise.

#include "broadmark/analysis/duel.h"
#include "broadmark/analysis/run_ratio.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <random>
#include <vector>

#include "engine/spoilt_cases.h"
#include "engine/uneven_machine.h"

namespace broadmark::tests {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// A host that does nothing in the given time on a simulated machine.
class TimedHost final : public CaseExecutor {
 public:
  TimedHost(std::shared_ptr<UnevenMachine> machine, double seconds)
      : machine_(std::move(machine)), seconds_(seconds) {}

  std::int64_t start(const SceneInfo&, const Frame&) override { return 0; }
  StepResult step(const Frame&) override {
    StepResult result;
    result.times[Phase::total] =
        static_cast<std::int64_t>(machine_->time(seconds_, own_noise_) * 1e9);
    return result;
  }
  void stop() override {}
  PairDigest digest() override { return {}; }
  PairRuns answer() override { return {}; }
  PairEvents events() override { return {}; }
  Counts counters() override { return {}; }
  Counts setup() override { return {}; }
  RecordedDrawing structure() override { return RecordedDrawing(); }
  std::string validate() override { return {}; }

 private:
  std::shared_ptr<UnevenMachine> machine_;
  double seconds_;
  double own_noise_ = 0;
};

/// A duel of algorithms with these times.
DuelResult duelOf(const std::vector<double>& seconds, unsigned seed, DuelOptions options) {
  const auto machine = std::make_shared<UnevenMachine>(seed);
  std::vector<DuelSide> sides;
  for (const double time : seconds) {
    sides.push_back(
        {std::to_string(time), caseOf(), [machine, time](const Case&, const CancelQuery&) {
           return std::make_unique<TimedHost>(machine, time);
         }});
  }
  ChainSource frames(4, 50);
  options.seed = seed;
  options.check = CheckMode::off;
  options.max_seconds = 3600;
  return runDuel(sides, frames, options);
}

/// Duels of the second of two algorithms against the first.
struct Outcomes {
  double claims = 0;  ///< share of duels that claim a difference
  double beyond = 0;  ///< share of those that claim one with a ratio beyond the limit
  double same = 0;    ///< share of those that find both the same
  double rounds = 0;  ///< mean
};
Outcomes outcomesOf(double ratio, int duels, const DuelOptions& options) {
  Outcomes outcomes;
  const double share = 1.0 / duels;
  for (int seed = 0; seed < duels; ++seed) {
    const DuelResult result = duelOf({1e-4, 1e-4 * ratio}, static_cast<unsigned>(seed), options);
    EXPECT_TRUE(result.decided);
    const Estimate found = result.ratio(1, 0);
    const Verdict verdict = verdictOn(found.ci95, result.margin);
    const bool claims = verdict == Verdict::faster || verdict == Verdict::slower;
    outcomes.claims += claims ? share : 0;
    outcomes.beyond += claims && found.value > 1 + options.limit ? share : 0;
    outcomes.same += verdict == Verdict::same ? share : 0;
    outcomes.rounds += static_cast<double>(result.rounds()) * share;
  }
  return outcomes;
}

DuelOptions withLimit(double error_rate = 0.05) {
  return {.limit = 0.05, .error_rate = error_rate};
}

TEST(Verdict, IsSameOnlyWithinTheMargin) {
  EXPECT_EQ(verdictOn({0.995, 1.005}, 0.01), Verdict::same);
  EXPECT_EQ(verdictOn({1.002, 1.008}, 0.01), Verdict::same) << "within the margin";
  EXPECT_EQ(verdictOn({1.002, 1.02}, 0.01), Verdict::slower);
  EXPECT_EQ(verdictOn({0.9, 0.99}, 0.01), Verdict::faster);
  EXPECT_EQ(verdictOn({0.42, 5.9}, 0.01), Verdict::undecided);
}

/// Two sides with these times in each round.
DuelResult resultOf(const std::vector<double>& first, const std::vector<double>& second) {
  DuelResult result;
  result.sides = {{.name = "first", .seconds = first}, {.name = "second", .seconds = second}};
  return result;
}

TEST(Duel, AnIntervalContainsItsEstimateAndIsOfPositiveNumbers) {
  std::mt19937 random(1);
  std::lognormal_distribution<double> wild(0, 3);
  for (std::size_t rounds = 20; rounds < 60; ++rounds) {
    std::vector<double> seconds(rounds);
    for (double& time : seconds) time = wild(random);
    const auto [ratio, interval] = resultOf(std::vector<double>(rounds, 1), seconds).ratio(1, 0);
    EXPECT_GT(interval.low, 0) << rounds;
    EXPECT_LE(interval.low, ratio) << rounds;
    EXPECT_GE(interval.high, ratio) << rounds;
  }
}

TEST(Duel, AFewRoundsAreTooFewForAnInterval) {
  const Interval none = resultOf({1, 1, 1, 1, 1}, {2, 2, 2, 2, 2}).ratio(1, 0).ci95;
  EXPECT_EQ(none.low, 0);
  EXPECT_EQ(verdictOn(none, 0.02), Verdict::undecided);
}

TEST(Duel, ClaimsNoDifferenceWhereThereIsNone) {
  const Outcomes outcomes = outcomesOf(1, 2000, withLimit());
  EXPECT_LE(outcomes.claims, 0.05);
  EXPECT_LE(outcomes.beyond, 0.001);
  EXPECT_GE(outcomes.same, 0.95);
}

// As a suite of twenty cases would ask for.
TEST(Duel, ClaimsNoDifferenceMoreOftenThanAskedFor) {
  EXPECT_LE(outcomesOf(1, 2000, withLimit(0.05 / 20)).claims, 0.0025);
}

TEST(Duel, FindsTrueDifferences) {
  EXPECT_GE(outcomesOf(1.05, 200, withLimit()).claims, 0.95);
  const Outcomes of_ten_percent = outcomesOf(1.1, 200, withLimit());
  EXPECT_GE(of_ten_percent.claims, 0.99);
  EXPECT_GE(of_ten_percent.beyond, 0.99);
  const Outcomes faster = outcomesOf(1 / 1.1, 200, withLimit());
  EXPECT_GE(faster.claims, 0.99);
  EXPECT_EQ(faster.beyond, 0);
}

TEST(Duel, EndsEarlyWhenTheVerdictIsPlain) {
  EXPECT_LE(outcomesOf(1.5, 50, withLimit()).rounds, 100);
  EXPECT_LE(outcomesOf(1 / 1.5, 50, withLimit()).rounds, 100);
  EXPECT_LE(outcomesOf(4, 50, {}).rounds, 100) << "without a limit";
  EXPECT_GT(outcomesOf(1.04, 50, withLimit()).rounds, 200);
}

TEST(Duel, IsReviewedAfterWholePasses) {
  for (const double ratio : {1.0, 1.1, 2.0}) {
    EXPECT_EQ(duelOf({1e-4, 1e-4 * ratio}, 1, withLimit()).rounds() % 50, 0U);
  }
}

TEST(Duel, EndsWithTheRoundOrThePassInWhichTimeIsUp) {
  const auto rounds = [](bool whole_passes) {
    ChainSource frames(4, 5);
    return runDuel({{"a", caseOf()}, {"b", caseOf()}}, frames,
                   {.max_seconds = 0, .whole_passes = whole_passes})
        .rounds();
  };
  EXPECT_EQ(rounds(false), 1U);
  EXPECT_EQ(rounds(true), 5U);
}

TEST(Duel, RanksWithTies) {
  const std::vector<DuelRank> ranking =
      duelOf({2e-4, 1e-4, 2e-4, 3e-4}, 3, {.precision = 0.03}).ranking;
  std::vector<std::size_t> numbers;
  for (const DuelRank& rank : ranking) numbers.push_back(rank.rank);
  EXPECT_THAT(numbers, ElementsAre(1, 2, 2, 4));
  EXPECT_EQ(ranking.front().side, 1U);
  EXPECT_EQ(ranking.back().side, 3U);
}

TEST(Duel, EndsAfterAPassInWhichASideIsWrong) {
  ChainSource frames;
  const Case wrong = spoilingAnswer([](std::vector<Pair>& answer) { answer.pop_back(); });
  const std::vector<DuelSide> sides = {{"right", caseOf()}, {"wrong", wrong}};
  const DuelResult result = runDuel(sides, frames, {});
  EXPECT_FALSE(result.ok());
  EXPECT_EQ(result.sides[0].status, Status::ok);
  EXPECT_EQ(result.sides[1].status, Status::mismatch);
  EXPECT_THAT(result.sides[1].reason, HasSubstr("frame 3"));
}

TEST(Duel, NamesAllSidesThatAreWrong) {
  ChainSource frames;
  const auto wrong_in = [](std::uint32_t wrong_frame) {
    return caseOf({.on_answer = [wrong_frame](std::uint32_t frame, std::vector<Pair>& answer) {
      if (frame == wrong_frame) answer.pop_back();
    }});
  };
  const DuelResult result =
      runDuel({{"in frame 2", wrong_in(2)}, {"in frame 5", wrong_in(5)}}, frames, {});
  for (const DuelResult::Side& side : result.sides) {
    EXPECT_EQ(side.status, Status::mismatch) << side.name;
  }
}

}  // namespace
}  // namespace broadmark::tests
