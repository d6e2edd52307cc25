#include "broadmark/analysis/duel.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <numeric>
#include <random>
#include <utility>

#include "broadmark/analysis/run_ratio.h"
#include "broadmark/error.h"

namespace broadmark {
namespace {

using Clock = std::chrono::steady_clock;

/// Minimum number of rounds of a plain verdict.
constexpr std::size_t kMinRounds = 60;
/// Where memory lies differs between processes, and with it times, by up to 10 % (tide). A verdict
/// on a smaller difference than this needs several processes.
constexpr double kProcessDifference = 1.25;
constexpr std::size_t kMinProcesses = 6;
/// Measured time after which each side gets a new process.
constexpr double kProcessSeconds = 0.05;
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

/// Whether more rounds could hardly change the verdict on this ratio, which is that of a side to a
/// faster one.
bool isPlain(const Estimate& ratio, const DuelOptions& options, double margin) {
  constexpr double kShareOfDifference = 25;
  const auto& [value, interval] = ratio;
  const double width = std::log(interval.high / interval.low);
  return width <=
             options.precision * std::max(1.0, kShareOfDifference * std::abs(std::log(value))) ||
         verdictOn(interval, margin) == Verdict::same || interval.low > 1 + options.limit;
}

class Duel {
 public:
  Duel(const std::vector<DuelSide>& sides, const DuelOptions& options)
      : sides_(sides), options_(options), order_(sides.size()), random_(options.seed) {
    std::iota(order_.begin(), order_.end(), 0);
    result_.margin = 2 * options.precision;
    result_.error_rate = options.error_rate;
    for (const DuelSide& side : sides) result_.sides.push_back({.name = side.name});
  }

  DuelResult run(FrameSource& frames) {
    for (bool first = true; !ended_; first = false) {
      if (process_seconds_ >= kProcessSeconds || first) startProcesses(first);
      runPass(frames, first);
      ended_ |= isTimeUp();
      for (const auto& case_run : runs_) case_run->stopChecking();
      if (frames.scene().frames == 0) ended_ = true;
      if (result_.ok() && result_.rounds() > 0) review();
    }
    for (const auto& case_run : runs_) case_run->stop();
    result_.seconds = elapsed();
    if (result_.ok() && result_.rounds() > 0) result_.ranking = ranking(result_);
    return std::move(result_);
  }

 private:
  [[nodiscard]] double elapsed() const {
    return std::chrono::duration<double>(Clock::now() - begin_).count();
  }

  [[nodiscard]] bool isTimeUp() const { return elapsed() >= options_.max_seconds; }

  /// Gives each side a new executor. Rounds before and after are independent.
  void startProcesses(bool checked) {
    const RunPolicy policy = RunPolicy::unlimited(checked ? options_.check : CheckMode::off);
    runs_.clear();
    for (const DuelSide& side : sides_) {
      runs_.push_back(std::make_unique<CaseRun>(side.test_case, policy, side.make_executor,
                                                options_.cancelled));
    }
    ++result_.processes;
    process_seconds_ = 0;
  }

  /// Calls act(side) for all sides in random order. A side drops out if act returns false.
  template <class Action>
  void runInRandomOrder(Action&& action) {
    std::ranges::shuffle(order_, random_);
    for (const std::size_t side : order_) {
      if (options_.cancelled && options_.cancelled()) throw Cancelled();
      if (result_.sides[side].status != Status::ok || action(side)) continue;
      result_.sides[side].status = runs_[side]->status();
      result_.sides[side].reason = runs_[side]->reason();
    }
  }

  /// Whether a side is left that may still turn out to be wrong.
  [[nodiscard]] bool isAnyLeft() const {
    return std::ranges::any_of(
        result_.sides, [](const DuelResult::Side& side) { return side.status == Status::ok; });
  }

  /// In the first pass, the answers of the other sides are checked even if one has dropped out.
  void runPass(FrameSource& frames, bool checked) {
    const Frame initial = frames.rewind();
    runInRandomOrder([&](std::size_t side) { return runs_[side]->start(frames.scene(), initial); });
    while (!ended_ && (result_.ok() || (checked && isAnyLeft()))) {
      const std::optional<Frame> frame = frames.next();
      if (!frame) break;
      runRound(*frame);
      if (checked) check(*frame);
      countRound();
    }
    ended_ |= !result_.ok();
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
    if (!result_.ok()) return;  // only complete rounds count
    for (std::size_t side = 0; side < seconds.size(); ++side) {
      result_.sides[side].seconds.push_back(seconds[side]);
      process_seconds_ += seconds[side];
    }
  }

  void check(const Frame& frame) {
    runInRandomOrder([&](std::size_t side) {
      runs_[side]->check(frame, oracle_);
      return runs_[side]->status() == Status::ok;
    });
  }

  void countRound() {
    result_.seconds = elapsed();
    if (options_.progress) options_.progress(result_);
    ended_ = !options_.whole_passes && isTimeUp();
  }

  /// Decides whether to end the duel. Its end is the last review.
  void review() {
    const std::size_t rounds = result_.rounds();
    if (rounds < next_review_ && !ended_) return;
    next_review_ = static_cast<std::size_t>(static_cast<double>(rounds) * kReviewGrowth) + 1;
    const auto number = static_cast<double>(++reviews_);
    result_.error_rate = options_.error_rate / (number * (number + 1));
    result_.decided = rounds >= kMinRounds && isDecided();
    ended_ |= result_.decided;
  }

  /// Whether the verdict on every side and the next faster one is plain.
  [[nodiscard]] bool isDecided() const {
    const std::vector<std::size_t> sides = fastestFirst(result_);
    for (std::size_t i = 1; i < sides.size(); ++i) {
      const Estimate ratio = result_.ratio(sides[i], sides[i - 1]);
      if (result_.processes < kMinProcesses && ratio.ci95.low < kProcessDifference) return false;
      if (!isPlain(ratio, options_, result_.margin)) return false;
    }
    return true;
  }

  const std::vector<DuelSide>& sides_;
  const DuelOptions& options_;
  std::vector<std::size_t> order_;
  std::mt19937_64 random_;
  std::vector<std::unique_ptr<CaseRun>> runs_;
  Oracle oracle_{Oracle::kBudgetBytes, kUnlimitedPairs, options_.cancelled};
  DuelResult result_;
  Clock::time_point begin_ = Clock::now();
  double process_seconds_ = 0;  ///< measured in the present processes
  std::size_t next_review_ = kMinRounds;
  std::size_t reviews_ = 0;
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
  // Times in one process are correlated. A few processes show nothing about others.
  const std::size_t block = processes < kMinProcesses ? 1 : rounds() / processes;
  const auto [median, interval] = medianOfSeries(logarithms, error_rate, block);
  return {std::exp(median), {std::exp(interval.low), std::exp(interval.high)}};
}

DuelResult runDuel(const std::vector<DuelSide>& sides, FrameSource& frames,
                   const DuelOptions& options) {
  return Duel(sides, options).run(frames);
}

}  // namespace broadmark
