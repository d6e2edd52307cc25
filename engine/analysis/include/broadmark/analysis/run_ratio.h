// How much slower the cases of one run are than those of another, at another time: from the same
// frames.
//
// Each frame counts with its least time over the repetitions, since what disturbs a frame makes it
// slower. Between two runs the machine changes, and all cases with it: a case's ratio is taken
// relative to the drift, the median of the other cases' ratios, in logarithms. Cases on the same
// recording took turns, so they share more of it. The interval covers the noise within the runs (a
// block bootstrap over the frames; half samples of the repetitions), or what the other cases differ
// from their drift by, whichever is more.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "broadmark/names.h"
#include "broadmark/results/results.h"
#include "broadmark/statistics/statistics.h"

namespace broadmark {

/// What is found of B against A; all but the first four only where runs are compared.
enum class Verdict {
  same,          ///< the whole interval is within the margin
  faster,        ///< the whole interval is below 1
  slower,        ///< the whole interval is above 1
  undecided,     ///< the interval is too wide to tell
  regressed,     ///< slower, by more than is tolerated, or no longer ok
  other_status,  ///< another status, but it was not ok before
  not_ok,        ///< the same status in both, not ok: its times say nothing
  not_timed,
  other_conditions,  ///< refused: times under such conditions are not to be compared
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

/// Same, faster, slower or undecided. Same comes first: what is on one side of 1 may be so near
/// that nobody cares.
Verdict verdictOn(const Interval& ratio, double margin);

/// Times of B / times of A.
struct RunRatio {
  // Mean over the frames of their least times, in seconds.
  double before = 0;
  double after = 0;
  /// (after / before) / (1 + drift); not divided where fewer than three others tell the drift.
  Estimate ratio;
  /// How much slower the other cases were in B, in the median: 0.1 is 10 %. Nothing if there are no
  /// others.
  std::optional<double> drift;
};

/// A case in both runs. Several runs may stand for A.
struct PairedCase {
  std::vector<const CaseResult*> before;
  const CaseResult* after = nullptr;
};

/// The ratios of all cases of two runs; nothing for a case without times. With three other cases or
/// more these tell how much runs differ, else three baselines or more do; without either at least
/// 8 % are taken for it, and the drift of one or two others widens the interval. The ratio of
/// identical times is 1.
std::vector<std::optional<RunRatio>> ratiosOfRuns(std::span<const PairedCase> cases);

/// The ratio of two cases of one run, whose repetitions took turns.
std::optional<RunRatio> ratioWithinRun(const CaseResult& before, const CaseResult& after);

}  // namespace broadmark
