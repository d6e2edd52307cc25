// Ratios of minimum times, and their intervals.

#include "broadmark/analysis/run_ratio.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

namespace broadmark {
namespace {

/// Minimum numbers of other cases, and of baselines, to estimate the variation between runs. With
/// fewer, a log half-width of the interval is assumed: whole runs on shared machines differ by
/// it; more for a side with a single repetition.
constexpr std::size_t kMinOthers = 3;
constexpr std::size_t kMinBaselines = 3;
constexpr double kUnknownRunSpread = 0.08;
constexpr double kUnknownRepetitionSpread = 0.15;

using PassTimes = std::vector<double>;  ///< seconds of each frame

/// The repetitions of one run.
struct TimedRun {
  std::vector<PassTimes> passes;
};

TimedRun runOf(const CaseResult& result) {
  TimedRun timed;
  for (const Repetition& repetition : result.repetitions) {
    PassTimes& pass = timed.passes.emplace_back();
    for (const FrameTimes& times : repetition.frames) {
      // The logarithm is defined even below the clock's resolution.
      pass.push_back(static_cast<double>(std::max<std::int64_t>(times[Phase::total], 1)) * 1e-9);
    }
  }
  return timed;
}

std::vector<const PassTimes*> passesOf(std::span<const TimedRun> runs) {
  std::vector<const PassTimes*> passes;
  for (const TimedRun& timed : runs) {
    for (const PassTimes& pass : timed.passes) passes.push_back(&pass);
  }
  return passes;
}

std::size_t framesOf(std::span<const TimedRun> runs) {
  std::size_t frames = std::numeric_limits<std::size_t>::max();
  for (const PassTimes* pass : passesOf(runs)) frames = std::min(frames, pass->size());
  return frames == std::numeric_limits<std::size_t>::max() ? 0 : frames;
}

/// The expected minimum of each frame over `drawn` random passes: the side with more passes would
/// otherwise have a lower minimum by chance.
std::vector<double> expectedMinimumTimes(std::span<const TimedRun> runs, std::size_t frames,
                                         std::size_t drawn) {
  const std::vector<const PassTimes*> passes = passesOf(runs);
  const auto count = static_cast<double>(passes.size());
  const auto draws = static_cast<double>(drawn);
  std::vector<double> minimum(frames);
  std::vector<double> times(passes.size());
  for (std::size_t frame = 0; frame < frames; ++frame) {
    std::ranges::transform(passes, times.begin(),
                           [&](const PassTimes* pass) { return (*pass)[frame]; });
    std::ranges::sort(times);
    // The probability that the i-th smallest time is the minimum of the drawn ones.
    double chance = draws / count;
    for (std::size_t i = 0; i + drawn <= times.size(); ++i) {
      minimum[frame] += chance * times[i];
      const auto rank = static_cast<double>(i);
      chance *= (count - draws - rank) / (count - 1 - rank);
    }
  }
  return minimum;
}

/// The logarithm of the mean of each frame's minimum over the passes but one, `left_out`.
double logMeanMinimum(const std::vector<const PassTimes*>& passes, std::size_t frames,
                      const PassTimes* left_out = nullptr) {
  double sum = 0;
  for (std::size_t frame = 0; frame < frames; ++frame) {
    double minimum = std::numeric_limits<double>::infinity();
    for (const PassTimes* pass : passes) {
      if (pass != left_out) minimum = std::min(minimum, (*pass)[frame]);
    }
    sum += minimum;
  }
  return std::log(sum / static_cast<double>(frames));
}

/// Variance of logMeanMinimum() by the jackknife (Tukey, 1958, "Bias and confidence in not-quite
/// large samples"). Requires at least two passes.
double varianceOfLogMean(const std::vector<const PassTimes*>& passes, std::size_t frames) {
  std::vector<double> levels;
  for (const PassTimes* pass : passes) levels.push_back(logMeanMinimum(passes, frames, pass));
  const auto count = static_cast<double>(passes.size());
  const double deviation = standardDeviation(levels);
  return deviation * deviation * (count - 1) * (count - 1) / count;
}

/// Noise between repetitions of both sides: a log half-width.
double repetitionNoise(std::span<const TimedRun> before, std::span<const TimedRun> after,
                       std::size_t frames) {
  const std::vector<const PassTimes*> a = passesOf(before);
  const std::vector<const PassTimes*> b = passesOf(after);
  if (a.size() < 2 || b.size() < 2) return 0;
  const auto degrees = static_cast<double>(a.size() + b.size() - 2);
  return studentT(0.05, degrees) *
         std::sqrt(varianceOfLogMean(a, frames) + varianceOfLogMean(b, frames));
}

/// Deviation of another run from the mean of the baselines: a log half-width.
double baselineSpread(std::span<const TimedRun> before, std::size_t frames) {
  std::vector<double> levels;
  for (const TimedRun& timed : before) {
    levels.push_back(logMeanMinimum(passesOf({&timed, 1}), frames));
  }
  const auto runs = static_cast<double>(levels.size());
  return studentT(0.05, runs - 1) * standardDeviation(levels) * std::sqrt(1 / runs + 1);
}

/// Noise between frames: the log half-width of the interval of the sums' ratio.
double frameNoise(std::span<const double> before, std::span<const double> after) {
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
  // The influence of each frame on the ratio.
  std::vector<double> influence(before.size());
  std::ranges::transform(before, after, influence.begin(),
                         [&](double a, double b) { return b - std::exp(estimate) * a; });
  const Interval interval =
      blockBootstrap95(before.size(), safeBlockLength(influence), estimate, log_of);
  return (interval.high - interval.low) / 2;
}

/// A case in isolation from the other cases. Ratio and noise are logarithms.
struct IsolatedRatio {
  double before = 0;  ///< seconds
  double after = 0;
  double ratio = 0;
  double noise = 0;        ///< within the runs: a half-width
  double spread = 0;       ///< between runs: a half-width
  bool identical = false;  ///< equal times in both runs
};

std::optional<IsolatedRatio> isolatedRatio(const PairedCase& paired) {
  std::vector<TimedRun> runs;
  for (const CaseResult* result : paired.before) runs.push_back(runOf(*result));
  const TimedRun judged = runOf(*paired.after);
  const std::span<const TimedRun> judged_run(&judged, 1);
  const std::size_t frames = std::min(framesOf(runs), framesOf(judged_run));
  if (frames == 0) return std::nullopt;

  const std::size_t drawn = std::min(passesOf(runs).size(), judged.passes.size());
  const std::vector<double> a = expectedMinimumTimes(runs, frames, drawn);
  const std::vector<double> b = expectedMinimumTimes(judged_run, frames, drawn);
  IsolatedRatio own{.before = mean(a), .after = mean(b)};
  own.identical = runs.size() == 1 && runs.front().passes == judged.passes;
  if (own.identical) return own;
  own.ratio = std::log(own.after / own.before);
  own.noise = std::hypot(frameNoise(a, b), repetitionNoise(runs, judged_run, frames));
  own.spread =
      std::hypot(runs.size() < kMinBaselines ? kUnknownRunSpread : baselineSpread(runs, frames),
                 drawn < 2 ? kUnknownRepetitionSpread : 0);
  return own;
}

RunRatio ratioFrom(const IsolatedRatio& own, double drift, double half) {
  const double ratio = own.ratio - drift;
  return {.before = own.before,
          .after = own.after,
          .ratio = {std::exp(ratio), {std::exp(ratio - half), std::exp(ratio + half)}},
          .drift = std::nullopt};
}

/// The cases of two runs, each in isolation: nullopt for cases without times.
class IsolatedRatios {
 public:
  explicit IsolatedRatios(std::span<const PairedCase> cases) : cases_(cases) {
    std::ranges::transform(cases, std::back_inserter(ratios_), isolatedRatio);
    for (std::size_t i = 0; i < ratios_.size(); ++i) drifts_.push_back(medianOfOthers(i));
  }

  [[nodiscard]] const std::optional<IsolatedRatio>& operator[](std::size_t i) const {
    return ratios_[i];
  }

  /// Median ratio of the other cases on the same recording, which ran alternately with this one, or
  /// of all others where those are fewer than two. Nothing without others.
  [[nodiscard]] std::optional<double> driftOf(std::size_t i) const { return drifts_[i]; }

  /// Half-width of the interval of the other cases' deviations from their drift, including the
  /// noise within their runs. nullopt if there are too few.
  [[nodiscard]] std::optional<double> spreadWithout(std::size_t i) const {
    std::vector<double> deviations;
    for (std::size_t j = 0; j < ratios_.size(); ++j) {
      if (j != i && ratios_[j]) deviations.push_back(std::abs(ratios_[j]->ratio - *drifts_[j]));
    }
    if (deviations.size() < kMinOthers) return std::nullopt;
    constexpr double kSigmas = 1.4826;  // for a normal distribution, from the median deviation
    return studentT(0.05, static_cast<double>(deviations.size() - 1)) * kSigmas *
           quantile(deviations, 0.5);
  }

 private:
  [[nodiscard]] std::optional<double> medianOfOthers(std::size_t i) const {
    constexpr std::size_t kMinAlternating = 2;
    std::vector<double> others = othersOf(i, true);
    if (others.size() < kMinAlternating) others = othersOf(i, false);
    if (others.empty()) return std::nullopt;
    return quantile(others, 0.5);
  }

  [[nodiscard]] std::vector<double> othersOf(std::size_t i, bool on_the_same_recording) const {
    std::vector<double> others;
    for (std::size_t j = 0; j < ratios_.size(); ++j) {
      const bool counts = !on_the_same_recording ||
                          cases_[j].after->recording.hash == cases_[i].after->recording.hash;
      if (j != i && ratios_[j] && counts) others.push_back(ratios_[j]->ratio);
    }
    return others;
  }

  std::span<const PairedCase> cases_;
  std::vector<std::optional<IsolatedRatio>> ratios_;
  std::vector<std::optional<double>> drifts_;
};

}  // namespace

std::vector<std::optional<RunRatio>> ratiosOfRuns(std::span<const PairedCase> cases) {
  const IsolatedRatios own(cases);
  std::vector<std::optional<RunRatio>> ratios(cases.size());
  for (std::size_t i = 0; i < cases.size(); ++i) {
    if (!own[i]) continue;
    if (own[i]->identical) {
      ratios[i] = ratioFrom(*own[i], 0, 0);
      continue;
    }
    const std::optional<double> drift = own.driftOf(i);
    if (const std::optional<double> spread = own.spreadWithout(i)) {
      // Both estimate this case's error: from its few repetitions, and from how far other cases are
      // off. Their mean square is closer than either (Smyth, 2004: moderated variances).
      ratios[i] = ratioFrom(*own[i], *drift, std::hypot(own[i]->noise, *spread) / std::sqrt(2.0));
    } else {
      // One or two others may have changed themselves: the ratio may be their drift or this case's.
      ratios[i] = ratioFrom(
          *own[i], 0, std::hypot(own[i]->noise, own[i]->spread) + std::abs(drift.value_or(0)));
    }
    if (drift) ratios[i]->drift = std::expm1(*drift);
  }
  return ratios;
}

std::optional<RunRatio> ratioWithinRun(const CaseResult& before, const CaseResult& after) {
  const std::optional<IsolatedRatio> own = isolatedRatio({.before = {&before}, .after = &after});
  if (!own) return std::nullopt;
  return ratioFrom(*own, 0, own->noise);
}

std::optional<RunRatio> ratioOfInstructions(const CaseResult& before, const CaseResult& after) {
  const std::optional<double> a = before.perFrame(ProcessorCounter::instructions);
  const std::optional<double> b = after.perFrame(ProcessorCounter::instructions);
  if (a.value_or(0) <= 0 || b.value_or(0) <= 0) return std::nullopt;
  const double ratio = *b / *a;
  return RunRatio{.before = *a,
                  .after = *b,
                  .ratio = {ratio, {ratio / (1 + kCountTolerance), ratio * (1 + kCountTolerance)}},
                  .drift = std::nullopt};
}

Verdict verdictOn(const Interval& ratio, double margin) {
  if (ratio.low >= 1 / (1 + margin) && ratio.high <= 1 + margin) return Verdict::same;
  if (ratio.low > 1) return Verdict::slower;
  if (ratio.high < 1) return Verdict::faster;
  return Verdict::undecided;
}

}  // namespace broadmark
