// How much slower one run of a case is than another, at another time: from the same frames.
//
// Each frame counts with its least time over the repetitions, since what disturbs a frame makes it
// slower. What is left between two runs is of three kinds, and the interval covers all of them:
// noise from frame to frame (a block bootstrap over the frames), noise from repetition to
// repetition and from run to run (their spread, as Student's t), and the drift of the machine
// between the runs (what the yardsticks differ by). Nothing is corrected.
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
  regressed,     ///< slower than is tolerated, or no longer ok
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
  // Mean over the frames of their least times, in seconds. The ratio is their quotient.
  double before = 0;
  double after = 0;
  Estimate ratio;
  /// How much slower the machine was during B, by the yardstick that differs most: 0.1 is 10 %.
  /// Nothing if a run has no yardsticks.
  std::optional<double> drift;
};

/// A case in one run.
struct CaseInRun {
  const CaseResult* result = nullptr;
  /// The yardsticks' least times while the recording was run; nothing if they were not measured.
  std::optional<YardstickTimes> pace = {};
};
/// The least times of all cases on the recording of this hash, which took turns.
std::optional<YardstickTimes> paceOf(const Results&, const std::string& recording_hash);

/// The ratio of one case in two runs over the same frames. Several runs may stand for A: three or
/// more tell how much runs differ, too. Nothing if there is no time to compare.
std::optional<RunRatio> ratioOfRuns(std::span<const CaseInRun> before, const CaseInRun& after);

}  // namespace broadmark
