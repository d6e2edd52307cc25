// What a case leaves behind: its times and its verdict.
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
  std::int64_t initialize_ns = 0;
  std::vector<FrameTimes> frames;
  ProcessorCounts processor = {};  ///< sums over the frames' four phases
};

/// What is counted in each frame: pairs in the answer (of events: that began or ended), bodies
/// whose boxes are not those of the frame before, and wrong pairs as in FrameDifference.
enum class FrameCount { pairs, changed_bodies, missed, false_pairs, allowed_extra, invalid };
inline constexpr NameTable kFrameCounts{{NamedValue{FrameCount::pairs, "pairs"},
                                         {FrameCount::changed_bodies, "changed_bodies"},
                                         {FrameCount::missed, "missed"},
                                         {FrameCount::false_pairs, "false"},
                                         {FrameCount::allowed_extra, "allowed_extra"},
                                         {FrameCount::invalid, "invalid"}}};

using FrameCounts = ValueOfEach<FrameCount, std::uint64_t, kFrameCounts.entries.size()>;

/// The recording a case ran on.
struct RecordingReference {
  SceneInfo scene;
  std::optional<std::uint64_t> seed;  ///< nothing for a recording from elsewhere
  std::string hash;
  std::string path;                  ///< "" when it was simulated for this run
  ParameterValues scene_parameters;  ///< all of them, when it was simulated
  ParameterValues swept = {};        ///< of those, what tells it from other recordings of its run
  /// How it was read, where that is not the default: as swept boxes; of an import also which
  /// elements of a mesh, …
  ParameterValues reading = {};
};

/// How many bodies were present in the frames that were run.
struct Population {
  double mean = 0;
  std::uint64_t max = 0;
};

struct CaseResult {
  std::string id;
  RecordingReference recording;
  std::string algorithm;
  std::string family;
  Isa isa = Isa::scalar;
  bool vectorised = false;  ///< whether the algorithm is vectorised, so that `isa` means something
  int threads = 1;
  std::string device;          ///< the compute device asked for, as ExecutionContext::device()
  std::string plugin;          ///< the file that the algorithm was loaded from; "": built in
  ParameterValues parameters;  ///< all, defaults included
  AnswerKind answer = AnswerKind::pairs;
  Conditions conditions;
  std::size_t environment = 0;  ///< where it ran: one of Results::environments

  Status status = Status::ok;
  std::string reason;  ///< for every status but ok

  // As FrameCount::pairs.
  double pairs_mean = 0;
  std::uint64_t pairs_max = 0;
  std::optional<Population> bodies;  ///< nothing where nobody is ever absent
  bool checked = false;              ///< when false, the counts of wrong pairs mean nothing
  /// Of each frame, over all repetitions the most of each kind. Empty in results/1.
  std::vector<FrameCounts> frames;
  // Sums of those.
  std::uint64_t missed_count = 0;
  std::uint64_t false_count = 0;
  std::uint64_t allowed_extra_count = 0;
  std::uint64_t invalid_count = 0;
  std::vector<FrameDifference> differences;  ///< of the frames that are mismatches
  std::optional<std::uint64_t> peak_bytes;   ///< as PassReport::peak_bytes
  /// The algorithm's own counts of work, mean per frame.
  std::map<std::string, double> counters;
  /// What it counted once, in the first initialisation.
  std::map<std::string, std::uint64_t> setup;

  std::vector<Repetition> repetitions;

  /// The total times in seconds, per repetition.
  [[nodiscard]] Summary summary() const;
  /// The mean of a phase per frame, over all repetitions; nothing if there is no frame.
  [[nodiscard]] std::optional<double> meanSeconds(Phase phase) const;
  /// The mean per frame, over the repetitions in which it was known; nothing if there is none.
  [[nodiscard]] std::optional<double> perFrame(ProcessorCounter which) const;
  /// How many frames were wrong in some repetition.
  [[nodiscard]] std::size_t mismatchedFrames() const;
  /// Whether it ran as often as was asked for, or ended by its status. A run that was interrupted
  /// leaves cases that did not.
  [[nodiscard]] bool isComplete() const;
};

}  // namespace broadmark
