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

#include "broadmark/results/results.h"
#include "broadmark/statistics/statistics.h"

namespace broadmark {

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
