// Least times, and an interval around their ratio.

#include "broadmark/run_ratio.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "block_bootstrap.h"

namespace broadmark {
namespace {

/// Between two runs of one repetition each, nothing tells how much repetitions differ: this much is
/// taken for it, as a logarithm. Whole runs on shared machines differ by that.
constexpr double kUnknownSpread = 0.15;
/// As many baselines tell how much runs differ.
constexpr std::size_t kFewestRuns = 3;

using PassTimes = std::vector<double>;  ///< seconds of each frame

/// The repetitions of one run.
struct TimedRun {
  std::vector<PassTimes> passes;
  std::vector<YardstickTimes> yardsticks;
};

TimedRun runOf(const CaseResult& result) {
  TimedRun run;
  for (const Repetition& repetition : result.repetitions) {
    PassTimes& pass = run.passes.emplace_back();
    for (const FrameTimes& times : repetition.frames) {
      // A time below the clock's resolution must still have a logarithm.
      pass.push_back(static_cast<double>(std::max<std::int64_t>(times[Phase::total], 1)) * 1e-9);
    }
    if (repetition.yardsticks) run.yardsticks.push_back(*repetition.yardsticks);
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

/// How slow a pass is as a whole, as a logarithm: typical of its frames.
double offsetOf(const PassTimes& pass, std::span<const double> least) {
  std::vector<double> ratios(least.size());
  std::ranges::transform(pass.begin(), pass.begin() + static_cast<std::ptrdiff_t>(least.size()),
                         least.begin(), least.end(), ratios.begin(),
                         [](double time, double best) { return std::log(time / best); });
  return quantile(ratios, 0.5);
}

/// How slow each pass is. One that was disturbed as a whole counts as slow as the quick ones allow:
/// it has no part in the least times.
std::vector<double> offsetsOf(const TimedRun& run, std::span<const double> least) {
  std::vector<double> offsets;
  for (const PassTimes& pass : run.passes) offsets.push_back(offsetOf(pass, least));
  const double median = quantile(offsets, 0.5);
  const double slowest = median + 2 * (median - quantile(offsets, 0));
  for (double& offset : offsets) offset = std::min(offset, slowest);
  return offsets;
}

/// A variance that is known from so many values beyond the first.
struct Spread {
  double squares = 0;
  double degrees = 0;

  void add(std::span<const double> values) {
    if (values.size() < 2) return;
    const double deviation = standardDeviation(values);
    const auto more = static_cast<double>(values.size() - 1);
    squares += deviation * deviation * more;
    degrees += more;
  }
  /// Half of the 95 % interval of a difference of two means, of `a` and `b` values.
  [[nodiscard]] double half(double a, double b) const {
    if (degrees == 0) return kUnknownSpread;
    return studentT975(degrees) * std::sqrt(squares / degrees * (1 / a + 1 / b));
  }
};

/// What repetitions, and runs, differ by: half of an interval, as a logarithm.
double repetitionNoise(std::span<const TimedRun> before, std::span<const double> least_before,
                       const TimedRun& after, std::span<const double> least_after) {
  Spread passes;
  Spread runs;
  double count = 0;
  std::vector<double> levels;
  for (const TimedRun& run : before) {
    const std::vector<double> offsets = offsetsOf(run, least_before);
    passes.add(offsets);
    levels.push_back(mean(offsets));
    count += static_cast<double>(run.passes.size());
  }
  passes.add(offsetsOf(after, least_after));
  const double noise = passes.half(count, static_cast<double>(after.passes.size()));
  if (before.size() < kFewestRuns) return noise;
  runs.add(levels);
  return std::max(noise, runs.half(static_cast<double>(before.size()), 1));
}

/// Mean logarithm of a yardstick's times; nothing without any.
std::optional<double> levelOf(std::span<const TimedRun> runs, Yardstick which) {
  std::vector<double> logs;
  for (const TimedRun& run : runs) {
    for (const YardstickTimes& times : run.yardsticks) {
      logs.push_back(std::log(static_cast<double>(std::max<std::int64_t>(times[which], 1))));
    }
  }
  return logs.empty() ? std::nullopt : std::optional(mean(logs));
}

/// By how much the machine was slower during `after`, as a logarithm.
std::optional<double> driftBetween(std::span<const TimedRun> before, const TimedRun& after) {
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
  const auto logOf = [&](std::span<const std::size_t> drawn) {
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
  const double estimate = logOf(all);
  // What each frame does to the ratio.
  std::vector<double> influence(before.size());
  std::ranges::transform(before, after, influence.begin(),
                         [&](double a, double b) { return b - std::exp(estimate) * a; });
  return blockBootstrap95(before.size(), safeBlockLength(influence), estimate, logOf);
}

}  // namespace

std::optional<RunRatio> ratioOfRuns(std::span<const CaseResult* const> before,
                                    const CaseResult& after) {
  std::vector<TimedRun> runs;
  for (const CaseResult* result : before) runs.push_back(runOf(*result));
  const TimedRun judged = runOf(after);
  const std::span<const TimedRun> alone(&judged, 1);
  const std::size_t frames = std::min(framesOf(runs), framesOf(alone));
  if (frames == 0) return std::nullopt;

  const std::size_t drawn = std::min(passesOf(runs).size(), judged.passes.size());
  const std::vector<double> a = leastTimes(runs, frames, drawn);
  const std::vector<double> b = leastTimes(alone, frames, drawn);
  RunRatio result{.before = mean(a), .after = mean(b), .ratio = {}, .drift = {}};
  const double estimate = std::log(result.after / result.before);
  const std::optional<double> drift = driftBetween(runs, judged);
  const double repetitions = repetitionNoise(runs, a, judged, b);
  const Interval noise = frameNoise(a, b);
  const auto half = [&](double of_frames) {
    return std::hypot(of_frames, repetitions) + std::abs(drift.value_or(0));
  };
  result.ratio = {std::exp(estimate),
                  {std::exp(estimate - half(estimate - noise.low)),
                   std::exp(estimate + half(noise.high - estimate))}};
  if (drift) result.drift = std::expm1(*drift);
  return result;
}

}  // namespace broadmark
