// Advice on which case to choose for a recording: the parts that need no measurement.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "broadmark/analysis/duel.h"
#include "broadmark/analysis/run_ratio.h"
#include "broadmark/results/results.h"

namespace broadmark {

/// Measures these candidates under equal conditions and returns the cost of each; infinity for one
/// that must not be chosen.
using MeasureCosts = std::function<std::vector<double>(const std::vector<std::size_t>& candidates)>;

/// Successive halving (Jamieson and Talwalkar, 2016): measures the candidates 0…count - 1 and drops
/// the slower half, again and again, until at most `keep` are left. Returns these, the fastest
/// first. Measures at least once.
std::vector<std::size_t> halve(std::size_t count, std::size_t keep, const MeasureCosts& measure);

/// Frames that represent a recording: some stretches of it, evenly spread, or all.
struct Excerpt {
  std::vector<std::uint32_t> frames;  ///< ascending; the first is the initial pose
  /// Whether the time of a further frame counts: not at the beginning of a stretch, to which bodies
  /// jump.
  std::vector<bool> counts;
  std::size_t stretches = 1;
};

/// An excerpt of about `wanted` of the `frames` frames after the initial pose.
Excerpt excerptOf(std::uint32_t frames, std::uint32_t wanted);

/// Values of a parameter to compare with its present one: a quarter, half, twice and four times as
/// much, within the range; where that is 0, some shares of `length`; the other choices. None for a
/// text.
std::vector<std::string> valuesAround(const Parameter&, double length);

/// The times of a side that has run an excerpt in whole passes, in `processes` processes: for every
/// process, approximately, a repetition with the minimum time of each frame that counts.
std::vector<Repetition> repetitionsOf(const DuelResult::Side&, const Excerpt&,
                                      std::size_t processes);

/// A case that was measured to the end.
struct Finalist {
  Case test_case;
  RunRatio ratio;  ///< its times to those of the first choice
};

struct Advice {
  Answer answer;
  int threads = 1;
  std::vector<Finalist> finalists;  ///< the fastest first, each of another algorithm
  /// The first choice with default parameters, if these are slower.
  std::optional<Finalist> untuned;
  std::string effort;              ///< what was measured: "12 algorithms …"
  std::vector<std::string> wrong;  ///< disqualified: "mine: mismatch: frame 3: 1 missed, …"
};

/// Differences within this share are of no importance.
inline constexpr double kAdviceMargin = 0.02;

/// Formats the advice as a paragraph, followed by the lines that use the first choice. `source`:
/// the arguments that open the recording.
std::string adviceText(const Advice&, const std::string& source);

}  // namespace broadmark
