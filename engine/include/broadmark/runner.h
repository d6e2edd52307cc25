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

/// How answers are compared with the oracle's: as sets, or by count and hash (sets all the same
/// for a conservative algorithm, and where the hashes differ), or not at all.
enum class CheckMode { full, hash, off };

/// An instance of a case's algorithm with all that must outlive it.
class CaseInstance {
 public:
  /// Throws UnsupportedError when it cannot run here on so many bodies, InputError for bad
  /// parameters.
  CaseInstance(const Case&, const SceneInfo&);

  BroadPhase& algorithm() { return *algorithm_; }
  [[nodiscard]] const BroadPhase& algorithm() const { return *algorithm_; }
  [[nodiscard]] const Capabilities& capabilities() const { return capabilities_; }

  /// Returns its duration in nanoseconds.
  std::int64_t initialize(const SceneInfo&, const Frame& first);
  /// How the present answer differs from the right one for this frame, the last one run. Not for
  /// CheckMode::off.
  [[nodiscard]] FrameDifference check(const Frame&, Oracle&, CheckMode) const;

 private:
  Execution execution_;
  std::unique_ptr<BroadPhase> algorithm_;
  Capabilities capabilities_;
};

struct RunOptions {
  CheckMode check = CheckMode::full;
  std::uint32_t first_checked = 1;  ///< frames before this one are not checked
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
/// if it cannot be had, as for algorithms on a compute device: a child has no part in its driver.
std::optional<std::uint64_t> measurePeakBytes(const Case&, FrameSource&);

}  // namespace broadmark
