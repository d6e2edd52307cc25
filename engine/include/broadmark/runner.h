// Running an algorithm over a scene: the one place where time is taken.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "broadmark/algorithm.h"
#include "broadmark/frame.h"
#include "broadmark/oracle.h"
#include "broadmark/results.h"

namespace broadmark {

/// Runs the four phases on one frame and times them. Nothing else happens inside the clock.
/// Benchmark and inspector both call this.
FrameTimes runFrame(BroadPhase&, const Frame&);

/// What to run: an algorithm with all that can vary about it.
struct Case {
  Algorithm algorithm;
  Isa isa = Isa::scalar;
  int threads = 1;
  std::string device;          ///< as Execution::device()
  ParameterValues parameters;  ///< those that differ from the default
};

/// "bf-simd-mt/avx2/t4/key=value": what of a case does not depend on the recording.
std::string caseName(const Case&);
/// "FreeFall/Cubes/N2000/F100/" + caseName; with the seed "/s7" when it is known.
std::string caseId(const RecordingReference&, const Case&);

enum class CheckMode { full, hash, off };

struct RunOptions {
  CheckMode check = CheckMode::full;
  /// Limit on the running mean of a frame's total, judged after three frames.
  double frame_limit_seconds = 0.5;
  double initialize_limit_seconds = 60;
  /// Asked between frames; true ends the repetition without a result.
  std::function<bool()> cancelled;
  /// Told after each frame.
  std::function<void(std::uint32_t frame)> progress;
};

/// A result with everything but measurements.
CaseResult beginCase(const Case&, const RecordingReference&);

/// One pass of a fresh instance over `source`, added to `result`: times, pairs, differences,
/// status. What the algorithm throws becomes the status. Throws InputError (bad recording, bad
/// parameters). Returns false when cancelled (the repetition is then dropped). `measured` = false:
/// a warm-up, checked but with its times dropped.
bool runRepetition(CaseResult& result, const Case&, FrameSource& source, Oracle&, const RunOptions&,
                   bool measured = true);

/// Runs a few repetitions of one case: the short way for programs of your own.
CaseResult runCase(const Case&, FrameSource&, const RunOptions& = {}, int repetitions = 1);

/// Growth of the process's peak memory over one untimed pass in a child process, in bytes; nothing
/// if it cannot be had.
std::optional<std::uint64_t> measurePeakBytes(const Case&, FrameSource&);

}  // namespace broadmark
