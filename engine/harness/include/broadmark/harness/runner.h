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

/// "FreeFall/Cubes/N2000/F100"; with a known seed, also "/s7"; then "/key=value" for swept
/// parameters and reading options.
std::string recordingId(const RecordingReference&);
/// recordingId() + '/' + caseName().
std::string caseId(const RecordingReference&, const Case&);
/// caseName() of the result's case: its id without the recording's.
std::string caseNameOf(const CaseResult&);
/// caseNameOf() without instruction set and threads: "kd-mt/avx2/t4/margin=0.1" is
/// "kd-mt/margin=0.1".
std::string variantOf(const CaseResult&);

/// A result without measurements, with status ok and default Conditions. Throws InputError for an
/// invalid parameter of the case.
CaseResult beginCase(const Case&, const RecordingReference&);

/// Callbacks for a running repetition.
struct RunHooks {
  /// Polled before each frame; true ends the repetition without a result. May be empty.
  std::function<bool()> cancelled;
  /// Called after each frame, from 1 on, with its index. May be empty.
  std::function<void(std::uint32_t frame)> progress;
};

/// Runs a pass over `source` from its initial pose, and adds to `result`: times, pairs,
/// differences, status. A failure of the algorithm, too, returns true; one that ends its instance
/// adds no repetition. Throws InputError (bad recording, no such device). Returns false when
/// cancelled, without adding the repetition or the status, although counts and differences of its
/// frames remain. `measured` = false: a warm-up, checked but not timed.
bool runRepetition(CaseResult& result, CaseRun& case_run, FrameSource& source, Oracle&,
                   const RunHooks& hooks = {}, bool measured = true);

/// Runs up to `repetitions` of one case in this process, until its status is not ok: a shortcut for
/// your own programs. The result's recording has only its scene, and its conditions do not state
/// the policy. Throws InputError, as runRepetition().
CaseResult runCase(const Case&, FrameSource&, const RunPolicy& = {}, int repetitions = 1);

}  // namespace broadmark
