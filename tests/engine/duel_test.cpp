// Duels: their statistics on machines that are made up, with all the noise that real ones have.

#include "broadmark/duel.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "engine/spoilt_cases.h"

namespace broadmark::tests {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// A machine whose pace changes: it drifts, and now and then something else takes half of it for a
/// while. All who share it share that.
class Machine {
 public:
  explicit Machine(unsigned seed) : random_(seed) {}

  /// The time of work that takes `seconds` on a quiet machine: with noise of its own that resembles
  /// the noise before, and a heavy tail.
  double time(double seconds, double& own_noise) {
    drift_ += 0.002 * normal_(random_);
    if (burst_ == 0 && uniform_(random_) < 0.01) burst_ = 20;
    if (burst_ > 0) --burst_;
    own_noise = 0.5 * own_noise + 0.03 * normal_(random_);
    const double tail = uniform_(random_) < 0.02 ? 1 + 4 * uniform_(random_) : 1;
    return seconds * std::exp(drift_ + own_noise) * tail * (burst_ > 0 ? 1.5 : 1);
  }

 private:
  std::mt19937 random_;
  std::normal_distribution<double> normal_;
  std::uniform_real_distribution<double> uniform_;
  double drift_ = 0;
  int burst_ = 0;
};

/// An algorithm that takes so long on that machine, and does nothing.
class TimedHost final : public CaseHost {
 public:
  TimedHost(std::shared_ptr<Machine> machine, double seconds)
      : machine_(std::move(machine)), seconds_(seconds) {}

  std::int64_t start(const SceneInfo&, const Frame&) override { return 0; }
  FrameRun step(const Frame&) override {
    FrameRun run;
    run.times[Phase::total] = static_cast<std::int64_t>(machine_->time(seconds_, own_noise_) * 1e9);
    return run;
  }
  void stop() override {}
  PairDigest digest() override { return {}; }
  PairRuns answer() override { return {}; }
  Counts counters() override { return {}; }
  Counts setup() override { return {}; }
  RecordedDrawing structure() override { return {}; }

 private:
  std::shared_ptr<Machine> machine_;
  double seconds_;
  double own_noise_ = 0;
};

/// A duel of algorithms that take so long.
DuelResult duelOf(const std::vector<double>& seconds, unsigned seed, double precision) {
  const auto machine = std::make_shared<Machine>(seed);
  std::vector<DuelSide> sides;
  for (const double each : seconds) {
    sides.push_back(
        {std::to_string(each), caseOf(), [machine, each](const Case&, const CancelQuery&) {
           return std::make_unique<TimedHost>(machine, each);
         }});
  }
  ChainSource frames(4, 50);
  return runDuel(sides, frames, {.precision = precision, .seed = seed, .check = CheckMode::off});
}

TEST(Standing, IsSameOnlyWithinTheMargin) {
  EXPECT_EQ(standingOf({0.995, 1.005}, 0.01), Standing::same);
  EXPECT_EQ(standingOf({1.002, 1.008}, 0.01), Standing::same) << "less than anybody asks for";
  EXPECT_EQ(standingOf({1.002, 1.02}, 0.01), Standing::slower);
  EXPECT_EQ(standingOf({0.9, 0.99}, 0.01), Standing::faster);
  EXPECT_EQ(standingOf({0.42, 5.9}, 0.01), Standing::undecided);
}

TEST(Duel, ClaimsNoDifferenceWhereThereIsNone) {
  int claims = 0;
  constexpr int kDuels = 60;
  for (int seed = 0; seed < kDuels; ++seed) {
    const DuelResult result = duelOf({1e-4, 1e-4}, static_cast<unsigned>(seed), 0.02);
    EXPECT_TRUE(result.decided);
    const Standing standing = standingOf(result.ratio(1, 0).ci95, 0.02);
    claims += standing == Standing::faster || standing == Standing::slower ? 1 : 0;
  }
  EXPECT_LE(claims, kDuels / 20);
}

TEST(Duel, FindsADifferenceOfTenPercent) {
  int found = 0;
  constexpr int kDuels = 40;
  for (int seed = 0; seed < kDuels; ++seed) {
    const DuelResult result = duelOf({1e-4, 1.1e-4}, static_cast<unsigned>(seed), 0.02);
    const Estimate ratio = result.ratio(1, 0);
    EXPECT_NEAR(ratio.value, 1.1, 0.025);
    found += standingOf(ratio.ci95, 0.02) == Standing::slower ? 1 : 0;
  }
  EXPECT_GE(found, kDuels * 9 / 10);
}

TEST(Duel, RanksWithTies) {
  const DuelResult result = duelOf({2e-4, 1e-4, 2e-4, 3e-4}, 3, 0.03);
  const std::vector<DuelPlace> places = ranking(result, 0.03);
  std::vector<std::size_t> numbers;
  for (const DuelPlace& place : places) numbers.push_back(place.place);
  EXPECT_THAT(numbers, ElementsAre(1, 2, 2, 4));
  EXPECT_EQ(places.front().side, 1U);
  EXPECT_EQ(places.back().side, 3U);
}

TEST(Duel, EndsAtOnceWhenASideIsWrong) {
  ChainSource frames;
  const Case wrong = spoilingAnswer([](std::vector<Pair>& answer) { answer.pop_back(); });
  const std::vector<DuelSide> sides = {{"right", caseOf()}, {"wrong", wrong}};
  const DuelResult result = runDuel(sides, frames, {});
  EXPECT_FALSE(result.ok());
  EXPECT_EQ(result.sides[0].status, Status::ok);
  EXPECT_EQ(result.sides[1].status, Status::mismatch);
  EXPECT_THAT(result.sides[1].reason, HasSubstr("frame 3"));
}

}  // namespace
}  // namespace broadmark::tests
