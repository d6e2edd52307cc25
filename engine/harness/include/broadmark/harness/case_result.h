// The results of a case: its times and its status.
//
// Example:
//
//   const auto microsecondsPerFrame = [](const CaseResult& result, Phase phase) {
//     if (result.status != Status::ok) return 0.0;  // result.reason states the cause
//     return 1e6 * result.meanSeconds(phase).value_or(0);
//   };
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "broadmark/execution.h"
#include "broadmark/frame.h"
#include "broadmark/harness/conditions.h"
#include "broadmark/harness/frame_times.h"
#include "broadmark/harness/oracle.h"
#include "broadmark/harness/processor_counters.h"
#include "broadmark/harness/status.h"
#include "broadmark/parameters.h"
#include "broadmark/statistics/statistics.h"

namespace broadmark {

/// One pass of a fresh instance over the whole recording.
struct Repetition {
  std::int64_t initialize_ns = 0;  ///< as CaseExecutor::start(); 0 unless CaseResult::timed()
  /// From frame 1 on, in order: fewer than the recording's after a timeout. Empty unless timed().
  std::vector<FrameTimes> frames;
  ProcessorCounts processor = {};  ///< sums over the four phases of all frames
};

/// The counts of each frame: pairs in the answer (for events: begun or ended), bodies with
/// boxes that differ from the frame before, and wrong pairs as in FrameDifference.
enum class FrameCount { pairs, changed_bodies, missed, false_pairs, allowed_extra, invalid };
inline constexpr NameTable kFrameCounts{{NamedValue{FrameCount::pairs, "pairs"},
                                         {FrameCount::changed_bodies, "changed_bodies"},
                                         {FrameCount::missed, "missed"},
                                         {FrameCount::false_pairs, "false"},
                                         {FrameCount::allowed_extra, "allowed_extra"},
                                         {FrameCount::invalid, "invalid"}}};

/// The counts of one frame, by FrameCount.
using FrameCounts = ValueOfEach<FrameCount, std::uint64_t, kFrameCounts.entries.size()>;

/// The recording a case ran on.
struct RecordingReference {
  SceneInfo scene;                    ///< after the reading options
  std::optional<std::uint64_t> seed;  ///< nullopt for a foreign recording
  std::string hash;                   ///< of the recording's adapted boxes, as adaptedHash()
  std::string path;                   ///< "" if simulated for this run
  ParameterValues scene_parameters;   ///< all of them, if simulated
  ParameterValues swept = {};         ///< values that differ between the recordings of a run
  /// Non-default reading options: as swept boxes; for an import also the mesh elements, …
  ParameterValues reading = {};
};

/// The number of bodies present in the frames that were run, without the initial pose.
struct Population {
  double mean = 0;
  std::uint64_t max = 0;
};

/// Means over the first and the last tenth of a pass's frames: the algorithm's counters, and
/// "private_bytes", as PassReport::private_bytes. In a structure that ages well they agree.
struct Ageing {
  std::map<std::string, double> early;
  std::map<std::string, double> late;
};

struct CaseResult {
  // One case on one recording. Status, differences and counts of wrong pairs include warm-up
  // passes.

  std::string id;  ///< as caseId()
  RecordingReference recording;
  std::string algorithm;  ///< its id: "kd-mt"
  std::string family;     ///< as Algorithm::family
  Isa isa = Isa::scalar;
  bool vectorised = false;     ///< whether `isa` applies
  int threads = 1;             ///< the calling thread included
  std::string device;          ///< as requested, see ExecutionContext::device()
  std::string plugin;          ///< the algorithm's plug-in file; "": built in
  ParameterValues parameters;  ///< all, defaults included
  Answer answer = {};          ///< as Case::answer
  Conditions conditions;
  std::size_t environment = 0;  ///< index in Results::environments

  Status status = Status::ok;  ///< as CaseRun::status()
  std::string reason;          ///< for every status but ok

  // As FrameCount::pairs, in the first repetition.
  double pairs_mean = 0;
  std::uint64_t pairs_max = 0;
  std::optional<Population> bodies;  ///< nullopt if no body is ever absent
  bool checked = false;              ///< if false, the counts of wrong pairs are meaningless
  /// Per frame, the maxima over all repetitions. Empty in results/1.
  std::vector<FrameCounts> frames;
  // Sums over the frames.
  std::uint64_t missed_count = 0;
  std::uint64_t false_count = 0;
  std::uint64_t allowed_extra_count = 0;
  std::uint64_t invalid_count = 0;
  std::vector<FrameDifference> differences;  ///< for each mismatched frame
  std::optional<std::uint64_t> peak_bytes;   ///< as PassReport::peak_bytes
  /// The algorithm's work counters, mean per frame.
  std::map<std::string, double> counters;
  /// Of a first pass with at least 100 frames.
  std::optional<Ageing> ageing;
  /// Counters of the first initialisation.
  std::map<std::string, std::uint64_t> setup;

  std::vector<Repetition> repetitions;  ///< measured ones, in the order of their execution

  /// Statistics of Phase::total in seconds, over all repetitions; zeros without frames. O(n log n)
  /// for n frames in total.
  [[nodiscard]] Summary summary() const;
  /// The mean of a phase per frame in seconds, over all repetitions; nullopt without frames.
  [[nodiscard]] std::optional<double> meanSeconds(Phase phase) const;
  /// Whether times were measured, rather than instructions counted.
  [[nodiscard]] bool timed() const { return !conditions.counted_by; }
  /// The mean per frame, over the repetitions with this counter; nullopt if there are none.
  [[nodiscard]] std::optional<double> perFrame(ProcessorCounter which) const;
  /// The number of frames with a mismatch in some pass.
  [[nodiscard]] std::size_t mismatchedFrames() const;
  /// Whether all requested repetitions ran, or the status ended the case. An interrupted run leaves
  /// incomplete cases.
  [[nodiscard]] bool isComplete() const;
};

}  // namespace broadmark
