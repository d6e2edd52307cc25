// Least times, and an interval around their ratio.

#include "broadmark/analysis/run_ratio.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "broadmark/statistics/block_bootstrap.h"

namespace broadmark {
namespace {

/// Between two runs of one repetition each, nothing tells how much repetitions differ: this much is
/// taken for it, as a logarithm. Whole runs on shared machines differ by that.
constexpr double kUnknownSpread = 0.15;
/// As many baselines tell how much runs differ, beside what repetitions and yardsticks show. Fewer
/// do not: then this much is taken for it, likewise.
constexpr std::size_t kFewestRuns = 3;
constexpr double kUnknownRunSpread = 0.08;

using PassTimes = std::vector<double>;  ///< seconds of each frame

/// The repetitions of one run.
struct TimedRun {
  std::vector<PassTimes> passes;
};

TimedRun runOf(const CaseResult& result) {
  TimedRun run;
  for (const Repetition& repetition : result.repetitions) {
    PassTimes& pass = run.passes.emplace_back();
    for (const FrameTimes& times : repetition.frames) {
      // A time below the clock's resolution must still have a logarithm.
      pass.push_back(static_cast<double>(std::max<std::int64_t>(times[Phase::total], 1)) * 1e-9);
    }
  }
  return run;
}

std::vector<const PassTimes*> passesOf(std::span<const TimedRun> runs) {
  std::vector<const PassTimes*> passes;
  for (const TimedRun& run : runs) {
    for (const PassTimes& pass : run.passes) passes.push_back(&pass);
  }
  return passes;
}

std::size_t framesOf(std::span<const TimedRun> runs) {
  std::size_t frames = std::numeric_limits<std::size_t>::max();
  for (const PassTimes* pass : passesOf(runs)) frames = std::min(frames, pass->size());
  return frames == std::numeric_limits<std::size_t>::max() ? 0 : frames;
}

/// For each frame the least time to be expected of `drawn` of the passes: where one side has more
/// passes than the other its least time would be less by chance.
std::vector<double> leastTimes(std::span<const TimedRun> runs, std::size_t frames,
                               std::size_t drawn) {
  const std::vector<const PassTimes*> passes = passesOf(runs);
  const auto count = static_cast<double>(passes.size());
  const auto few = static_cast<double>(drawn);
  std::vector<double> least(frames);
  std::vector<double> times(passes.size());
  for (std::size_t frame = 0; frame < frames; ++frame) {
    std::ranges::transform(passes, times.begin(),
                           [&](const PassTimes* pass) { return (*pass)[frame]; });
    std::ranges::sort(times);
    // The chance that the i-th is the least of those drawn.
    double chance = few / count;
    for (std::size_t i = 0; i + drawn <= times.size(); ++i) {
      least[frame] += chance * times[i];
      const auto rank = static_cast<double>(i);
      chance *= (count - few - rank) / (count - 1 - rank);
    }
  }
  return least;
}

/// The logarithm of the mean of each frame's least time over some of the passes.
double levelOf(const std::vector<const PassTimes*>& passes, std::span<const std::size_t> chosen,
               std::size_t frames) {
  double sum = 0;
  for (std::size_t frame = 0; frame < frames; ++frame) {
    double least = std::numeric_limits<double>::infinity();
    for (const std::size_t pass : chosen) least = std::min(least, (*passes[pass])[frame]);
    sum += least;
  }
  return std::log(sum);
}

/// Variance of levelOf() all passes, from that of halves of them (McCarthy, 1969, "Pseudo-
/// replication: half samples"): a statistic of half of the values varies about its mean as that of
/// all does about the truth. At least two passes.
double varianceOfLevel(const std::vector<const PassTimes*>& passes, std::size_t frames) {
  constexpr int kHalves = 100;
  std::vector<std::size_t> order(passes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const std::size_t half = passes.size() / 2;
  std::mt19937_64 random;
  std::vector<double> levels(kHalves);
  for (double& level : levels) {
    std::ranges::shuffle(order, random);
    level = levelOf(passes, std::span(order).first(half), frames);
  }
  const double deviation = standardDeviation(levels);
  // An odd one out makes the halves differ by more than that.
  return deviation * deviation * static_cast<double>(half) /
         static_cast<double>(passes.size() - half);
}

/// What repetitions differ by: half of an interval, as a logarithm.
double repetitionNoise(std::span<const TimedRun> before, std::span<const TimedRun> after,
                       std::size_t frames) {
  const std::vector<const PassTimes*> a = passesOf(before);
  const std::vector<const PassTimes*> b = passesOf(after);
  if (a.size() < 2 || b.size() < 2) return kUnknownSpread;
  const auto degrees = static_cast<double>(a.size() + b.size() - 2);
  return studentT975(degrees) * std::sqrt(varianceOfLevel(a, frames) + varianceOfLevel(b, frames));
}

/// What runs differ by, as far as there are enough of them to tell: likewise.
double runNoise(std::span<const TimedRun> before, std::size_t frames) {
  if (before.size() < kFewestRuns) return kUnknownRunSpread;
  std::vector<double> levels;
  for (const TimedRun& run : before) {
    const std::vector<const PassTimes*> passes = passesOf({&run, 1});
    std::vector<std::size_t> all(passes.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    levels.push_back(levelOf(passes, all, frames));
  }
  const auto runs = static_cast<double>(levels.size());
  // Of their mean, and of one more run.
  return studentT975(runs - 1) * standardDeviation(levels) * std::sqrt(1 / runs + 1);
}

/// Mean logarithm of a yardstick's least times in these runs; nothing unless all have it.
std::optional<double> levelOf(std::span<const CaseInRun> runs, Yardstick which) {
  double sum = 0;
  for (const CaseInRun& run : runs) {
    if (!run.pace) return std::nullopt;
    sum += std::log(static_cast<double>(std::max<std::int64_t>((*run.pace)[which], 1)));
  }
  return sum / static_cast<double>(runs.size());
}

/// By how much the machine was slower during `after`, as a logarithm.
std::optional<double> driftBetween(std::span<const CaseInRun> before, const CaseInRun& after) {
  double most = 0;
  for (const auto& yardstick : kYardsticks.entries) {
    const auto a = levelOf(before, yardstick.value);
    const auto b = levelOf({&after, 1}, yardstick.value);
    if (!a || !b) return std::nullopt;
    if (std::abs(*b - *a) > std::abs(most)) most = *b - *a;
  }
  return most;
}

/// Of the logarithm of the sums' ratio: noise from frame to frame.
Interval frameNoise(std::span<const double> before, std::span<const double> after) {
  const auto log_of = [&](std::span<const std::size_t> drawn) {
    double a = 0;
    double b = 0;
    for (const std::size_t frame : drawn) {
      a += before[frame];
      b += after[frame];
    }
    return std::log(b / a);
  };
  std::vector<std::size_t> all(before.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  const double estimate = log_of(all);
  // What each frame does to the ratio.
  std::vector<double> influence(before.size());
  std::ranges::transform(before, after, influence.begin(),
                         [&](double a, double b) { return b - std::exp(estimate) * a; });
  return blockBootstrap95(before.size(), safeBlockLength(influence), estimate, log_of);
}

}  // namespace

std::optional<YardstickTimes> paceOf(const Results& results, const std::string& recording_hash) {
  std::optional<YardstickTimes> pace;
  for (const CaseResult& result : results.cases) {
    if (result.recording.hash != recording_hash) continue;
    for (const Repetition& repetition : result.repetitions) {
      if (!repetition.yardsticks) continue;
      if (!pace) pace = repetition.yardsticks;
      for (const auto& yardstick : kYardsticks.entries) {
        std::int64_t& least = (*pace)[yardstick.value];
        least = std::min(least, (*repetition.yardsticks)[yardstick.value]);
      }
    }
  }
  return pace;
}

std::optional<RunRatio> ratioOfRuns(std::span<const CaseInRun> before, const CaseInRun& after) {
  std::vector<TimedRun> runs;
  for (const CaseInRun& run : before) runs.push_back(runOf(*run.result));
  const TimedRun judged = runOf(*after.result);
  const std::span<const TimedRun> alone(&judged, 1);
  const std::size_t frames = std::min(framesOf(runs), framesOf(alone));
  if (frames == 0) return std::nullopt;

  const std::size_t drawn = std::min(passesOf(runs).size(), judged.passes.size());
  const std::vector<double> a = leastTimes(runs, frames, drawn);
  const std::vector<double> b = leastTimes(alone, frames, drawn);
  RunRatio result{.before = mean(a), .after = mean(b), .ratio = {}, .drift = {}};
  const double estimate = std::log(result.after / result.before);
  const std::optional<double> drift = driftBetween(before, after);
  const double between = std::hypot(repetitionNoise(runs, alone, frames), runNoise(runs, frames));
  const Interval noise = frameNoise(a, b);
  const auto half = [&](double of_frames) {
    return std::hypot(of_frames, between) + std::abs(drift.value_or(0));
  };
  result.ratio = {std::exp(estimate),
                  {std::exp(estimate - half(estimate - noise.low)),
                   std::exp(estimate + half(noise.high - estimate))}};
  if (drift) result.drift = std::expm1(*drift);
  return result;
}

Verdict verdictOn(const Interval& ratio, double margin) {
  if (ratio.low >= 1 / (1 + margin) && ratio.high <= 1 + margin) return Verdict::same;
  if (ratio.low > 1) return Verdict::slower;
  if (ratio.high < 1) return Verdict::faster;
  return Verdict::undecided;
}

}  // namespace broadmark
