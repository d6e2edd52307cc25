#include "broadmark/analysis/duel.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <random>
#include <utility>

#include "broadmark/analysis/run_ratio.h"
#include "broadmark/error.h"

namespace broadmark {
namespace {

using Clock = std::chrono::steady_clock;

/// Minimum number of rounds.
constexpr std::size_t kMinRounds = 60;
/// Growth of the number of rounds between reviews: intervals narrow with its square root.
constexpr double kReviewGrowth = 1.3;

/// Sorts the sides by the median of their ratios to the first side.
std::vector<std::size_t> fastestFirst(const DuelResult& result) {
  std::vector<double> medians;
  for (std::size_t side = 0; side < result.sides.size(); ++side) {
    medians.push_back(quantile(result.ratios(side, 0), 0.5));
  }
  std::vector<std::size_t> sides(medians.size());
  std::iota(sides.begin(), sides.end(), 0);
  std::ranges::stable_sort(sides, {}, [&](std::size_t side) { return medians[side]; });
  return sides;
}

std::vector<DuelRank> ranking(const DuelResult& result) {
  std::vector<DuelRank> ranking;
  for (const std::size_t side : fastestFirst(result)) {
    ranking.push_back({.side = side, .ratio = {1, {1, 1}}});
    if (side != 0) ranking.back().ratio = result.ratio(side, 0);
  }
  std::size_t first = 0;  // of the current rank
  for (std::size_t i = 1; i < ranking.size(); ++i) {
    const Interval ratio = result.ratio(ranking[i].side, ranking[first].side).ci95;
    if (verdictOn(ratio, result.margin) == Verdict::slower) first = i;
    ranking[i].rank = first + 1;
  }
  return ranking;
}

class Duel {
 public:
  Duel(const std::vector<DuelSide>& sides, const DuelOptions& options)
      : options_(options), order_(sides.size()), random_(options.seed) {
    std::iota(order_.begin(), order_.end(), 0);
    RunPolicy policy = RunPolicy::unlimited(options.check);
    for (const DuelSide& side : sides) {
      runs_.push_back(
          std::make_unique<CaseRun>(side.test_case, policy, side.make_executor, options.cancelled));
      result_.sides.push_back({.name = side.name});
    }
  }

  DuelResult run(FrameSource& frames) {
    for (bool first = true; !ended_; first = false) {
      runPass(frames, first);
      for (const auto& case_run : runs_) case_run->stopChecking();
      if (frames.scene().frames == 0) ended_ = true;
    }
    for (const auto& case_run : runs_) case_run->stop();
    result_.seconds = elapsed();
    result_.margin = 2 * options_.precision;
    if (result_.ok() && result_.rounds() > 0) result_.ranking = ranking(result_);
    return std::move(result_);
  }

 private:
  [[nodiscard]] double elapsed() const {
    return std::chrono::duration<double>(Clock::now() - begin_).count();
  }

  /// Calls act(side) in random order; ends the duel if act returns false.
  template <class Action>
  void runInRandomOrder(Action&& action) {
    std::ranges::shuffle(order_, random_);
    for (const std::size_t side : order_) {
      if (options_.cancelled && options_.cancelled()) throw Cancelled();
      if (!action(side)) return fail(side);
    }
  }

  void fail(std::size_t side) {
    ended_ = true;
    result_.sides[side].status = runs_[side]->status();
    result_.sides[side].reason = runs_[side]->reason();
  }

  void runPass(FrameSource& frames, bool checked) {
    const Frame initial = frames.rewind();
    runInRandomOrder([&](std::size_t side) { return runs_[side]->start(frames.scene(), initial); });
    while (!ended_) {
      const std::optional<Frame> frame = frames.next();
      if (!frame) return;
      runRound(*frame);
      if (!ended_ && checked) check(*frame);
      if (!ended_) evaluate();
    }
  }

  void runRound(const Frame& frame) {
    std::vector<double> seconds(runs_.size());
    runInRandomOrder([&](std::size_t side) {
      const bool running = runs_[side]->step(frame);
      // The ratio is defined even below the clock's resolution.
      const auto ns = std::max<std::int64_t>(runs_[side]->times()[Phase::total], 1);
      seconds[side] = static_cast<double>(ns) * 1e-9;
      return running;
    });
    if (ended_) return;  // only complete rounds count
    for (std::size_t side = 0; side < seconds.size(); ++side) {
      result_.sides[side].seconds.push_back(seconds[side]);
    }
  }

  void check(const Frame& frame) {
    runInRandomOrder([&](std::size_t side) {
      runs_[side]->check(frame, oracle_);
      return runs_[side]->status() == Status::ok;
    });
  }

  /// Decides whether to end the duel.
  void evaluate() {
    const std::size_t rounds = result_.rounds();
    result_.seconds = elapsed();
    if (options_.progress) options_.progress(result_);
    const bool time_is_up = result_.seconds >= options_.max_seconds;
    if (rounds < next_review_ && !time_is_up) return;
    next_review_ = static_cast<std::size_t>(static_cast<double>(rounds) * kReviewGrowth) + 1;
    const bool narrow = rounds >= kMinRounds && isNarrow();
    // Twice in a row: a single narrow interval may be chance.
    result_.decided = std::exchange(was_narrow_, narrow) && narrow;
    ended_ = result_.decided || time_is_up;
  }

  /// Whether the ratio of every side to the next faster one is precise enough.
  [[nodiscard]] bool isNarrow() const {
    const std::vector<std::size_t> sides = fastestFirst(result_);
    for (std::size_t i = 1; i < sides.size(); ++i) {
      const Interval ratio = result_.ratio(sides[i], sides[i - 1]).ci95;
      if (ratio.high - ratio.low > options_.precision * ratio.low) return false;
    }
    return true;
  }

  const DuelOptions& options_;
  std::vector<std::size_t> order_;
  std::mt19937_64 random_;
  std::vector<std::unique_ptr<CaseRun>> runs_;
  Oracle oracle_;
  DuelResult result_;
  Clock::time_point begin_ = Clock::now();
  std::size_t next_review_ = kMinRounds;
  bool was_narrow_ = false;
  bool ended_ = false;
};

}  // namespace

bool DuelResult::ok() const {
  return std::ranges::all_of(sides, [](const Side& side) { return side.status == Status::ok; });
}

std::vector<double> DuelResult::ratios(std::size_t a, std::size_t b) const {
  std::vector<double> ratios(rounds());
  std::ranges::transform(sides[a].seconds, sides[b].seconds, ratios.begin(), std::divides());
  return ratios;
}

Estimate DuelResult::ratio(std::size_t a, std::size_t b) const {
  std::vector<double> logarithms = ratios(a, b);
  for (double& ratio : logarithms) ratio = std::log(ratio);
  const auto [median, interval] = medianOfSeries(logarithms);
  // The range of five values contains the median in only 94 of 100 cases.
  if (rounds() <= 5) return {std::exp(median), {0, std::numeric_limits<double>::infinity()}};
  return {std::exp(median), {std::exp(interval.low), std::exp(interval.high)}};
}

DuelResult runDuel(const std::vector<DuelSide>& sides, FrameSource& frames,
                   const DuelOptions& options) {
  return Duel(sides, options).run(frames);
}

}  // namespace broadmark
