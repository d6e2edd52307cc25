// Running a case over a whole recording, and collecting its results.
//
// Example:
//
//   const auto seconds_per_frame = [](const Algorithm& algorithm, FrameSource& frames) {
//     const CaseResult result = runCase({.algorithm = algorithm}, frames, {}, 3);
//     return result.status == Status::ok ? result.summary().seconds_per_frame : -1;
//   };
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "broadmark/harness/case_result.h"
#include "broadmark/harness/case_run.h"

namespace broadmark {

/// "FreeFall/Cubes/N2000/F100"; with a known seed, also "/s7".
std::string recordingId(const RecordingReference&);
/// recordingId() + '/' + caseName().
std::string caseId(const RecordingReference&, const Case&);
/// caseName() of the result's case: its id without the recording's.
std::string caseNameOf(const CaseResult&);
/// caseNameOf() without instruction set and threads: "kd-mt/avx2/t4/margin=0.1" is
/// "kd-mt/margin=0.1".
std::string variantOf(const CaseResult&);

/// A result without measurements.
CaseResult beginCase(const Case&, const RecordingReference&);

/// Callbacks for a running repetition.
struct RunHooks {
  /// Polled between frames; true ends the repetition without a result.
  std::function<bool()> cancelled;
  /// Called after each frame.
  std::function<void(std::uint32_t frame)> progress;
};

/// Runs a pass over `source` and adds to `result`: times, pairs, differences, status. Throws
/// InputError (bad recording, no such device). Returns false when cancelled, without adding the
/// repetition. `measured` = false: a warm-up, checked but not timed.
bool runRepetition(CaseResult& result, CaseRun& case_run, FrameSource& source, Oracle&,
                   const RunHooks& hooks = {}, bool measured = true);

/// Runs repetitions of one case: a shortcut for your own programs.
CaseResult runCase(const Case&, FrameSource&, const RunPolicy& = {}, int repetitions = 1);

}  // namespace broadmark
