// Time ratios between the cases of two separate runs, frame by frame, and ratios of instructions.
//
// Each frame counts with its minimum over the repetitions, since disturbances only slow frames
// down. The machine's speed may differ between two runs, for all cases: a case's ratio is relative
// to the drift, the median of the other cases' ratios, in logarithms. Cases on the same recording
// ran alternately, so they share more drift. The interval's width is the root mean square of two:
// the noise within the runs (a block bootstrap over the frames, the jackknife over the
// repetitions), and the deviation of the other cases from their drift.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "broadmark/names.h"
#include "broadmark/results/results.h"
#include "broadmark/statistics/statistics.h"

namespace broadmark {

/// The verdict on B against A; all but the first four only in comparisons of runs.
enum class Verdict {
  same,          ///< the whole interval is within the margin
  faster,        ///< the whole interval is below 1
  slower,        ///< the whole interval is above 1
  undecided,     ///< the interval is too wide
  regressed,     ///< slower by more than the tolerance, or no longer ok
  other_status,  ///< another status than in A, where it was not ok
  not_ok,        ///< the same status in both, other than ok: times are meaningless
  not_timed,
  other_conditions,  ///< refused: times under such conditions are not comparable
  other_recording,
  missing,  ///< only in A
  added,    ///< only in B
};
inline constexpr NameTable kVerdicts{{NamedValue{Verdict::same, "same"},
                                      {Verdict::faster, "faster"},
                                      {Verdict::slower, "slower"},
                                      {Verdict::undecided, "undecided"},
                                      {Verdict::regressed, "REGRESSED"},
                                      {Verdict::other_status, "other status"},
                                      {Verdict::not_ok, "not ok"},
                                      {Verdict::not_timed, "not timed"},
                                      {Verdict::other_conditions, "other conditions"},
                                      {Verdict::other_recording, "other recording"},
                                      {Verdict::missing, "missing"},
                                      {Verdict::added, "added"}}};

/// Same, faster, slower or undecided. Same has priority: a difference within the margin is
/// negligible.
Verdict verdictOn(const Interval& ratio, double margin);

/// Times of B / times of A, or instructions of B / instructions of A.
struct RunRatio {
  // Mean over the frames of their minimum times, in seconds; or of their instructions.
  double before = 0;
  double after = 0;
  /// (after / before) / (1 + drift); undivided with fewer than three other cases.
  Estimate ratio;
  /// The median slowdown of the other cases in B: 0.1 is 10 %. nullopt without other cases.
  std::optional<double> drift;
};

/// A case in both A and B. A may consist of several runs.
struct PairedCase {
  std::vector<const CaseResult*> before;
  const CaseResult* after = nullptr;
};

/// The ratios of all cases of two runs; nullopt for a case without times. The variation between
/// runs is estimated from at least three other cases, else from at least three baselines; without
/// either, at least 8 % is assumed, and the drift of one or two others widens the interval.
/// The ratio of identical times is 1.
std::vector<std::optional<RunRatio>> ratiosOfRuns(std::span<const PairedCase> cases);

/// Instruction counts of the same program and the same boxes differ by no more than this share.
inline constexpr double kCountTolerance = 0.001;
/// The margin with which a difference is claimed if, and only if, it exceeds kCountTolerance.
inline constexpr double kCountMargin = (1 + kCountTolerance) * (1 + kCountTolerance) - 1 + 1e-9;

/// The ratio of two cases' instructions per frame, with an interval of kCountTolerance; nullopt
/// unless both were counted.
std::optional<RunRatio> ratioOfInstructions(const CaseResult& before, const CaseResult& after);

/// The ratio of two cases of one run, with alternating repetitions.
std::optional<RunRatio> ratioWithinRun(const CaseResult& before, const CaseResult& after);

}  // namespace broadmark
