// An algorithm under observation: its case, and what it has done frame by frame.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "broadmark/harness/case_run.h"
#include "broadmark/render/frame_values.h"
#include "broadmark/results/frame_table.h"
#include "inspector/run/draw_gate.h"

namespace broadmark {

/// The result of a frame.
struct FrameRecord : FrameRow {
  bool run = false;  ///< false: nothing is known of this frame
  bool mismatch = false;
};

/// The records of a track as curves.
struct TrackCurves {
  std::array<FrameValues, kPhases.entries.size()> seconds;  ///< by phase
  FrameValues pairs;
  FrameValues disturbed;   ///< 1 in disturbed frames, unknown in others
  FrameValues mismatches;  ///< 1 in frames with a wrong answer, unknown in others

  void set(std::uint32_t frame, const FrameRecord& record);
};

/// An inspected case. The number tells identical cases apart.
struct TrackSpec {
  int number = 0;
  Case test_case;

  /// Whether both would do the same.
  friend bool operator==(const TrackSpec& a, const TrackSpec& b) {
    return a.number == b.number && a.test_case.device == b.test_case.device &&
           caseName(a.test_case) == caseName(b.test_case);
  }
};

/// Position and status of a track.
struct TrackState {
  TrackSpec spec;
  Status status = Status::ok;
  std::string reason;       ///< for every status but ok
  bool ended = false;       ///< it is not run any more: too slow, unsupported or broken
  std::uint32_t frame = 0;  ///< the last frame that it has run
  std::int64_t initialize_ns = 0;
  float margin = 0;
  std::map<std::string, std::uint64_t> setup;     ///< counted once, in the initialisation
  std::map<std::string, std::uint64_t> counters;  ///< of work, in the last frame
};

/// The results of a track; a copy stays valid while the track advances.
struct TrackReport : TrackState {
  std::vector<FrameRecord> frames;  ///< frame k at [k - 1]
  TrackCurves curves;               ///< of `frames`

  /// The record of a frame, or null when nothing is known of it.
  [[nodiscard]] const FrameRecord* record(std::uint32_t index) const {
    if (index == 0 || index > frames.size() || !frames[index - 1].run) return nullptr;
    return &frames[index - 1];
  }
};

/// The track of this number, or null.
const TrackReport* trackOf(const std::vector<TrackReport>& tracks, int number);

/// How many of the frames took longer.
std::uint64_t framesOver(const TrackReport& track, double ms);

/// The running track: a CaseRun, which starts another pass when an earlier frame is requested.
class AlgorithmTrack {
 public:
  /// A frame that takes longer, on average, ends the track.
  static constexpr double kFrameLimitSeconds = 10;

  /// `cancelled` is polled during long calls; if true, they throw Cancelled.
  explicit AlgorithmTrack(TrackSpec spec, ExecutorFactory make_host = makeLocalHost,
                          CancelQuery cancelled = {})
      : make_host_(std::move(make_host)), cancelled_(std::move(cancelled)) {
    report_.spec = std::move(spec);
  }

  [[nodiscard]] const TrackReport& report() const { return report_; }
  [[nodiscard]] const TrackSpec& spec() const { return report_.spec; }
  /// Whether its instance is at this frame: it can be asked for its answer, and can run the next
  /// frame unless it has ended.
  [[nodiscard]] bool standsAt(std::uint32_t index) const {
    return run_ && !outdated_ && (run_->running() || run_->answered()) && report_.frame == index;
  }

  // These throw nothing but Cancelled: what goes wrong becomes the status.
  /// A fresh instance, at the initial pose. What was recorded of later frames stays until they are
  /// run again. Not once it has ended.
  void restart(const SceneInfo& scene, const Frame& first);
  /// Runs the frame after the present one.
  void advance(const Frame& frame, DrawGate& gate);
  /// Compares the present answer with the right one; nothing when the algorithm is not checked.
  std::optional<FrameDifference> check(const Frame& frame, Oracle& oracle);

  /// Schedules a restart unless all frames run after this one were checked, as far as the
  /// algorithm can be.
  void requireChecked(std::uint32_t after);

  // Only while standsAt() some frame.
  std::vector<Pair> answer();
  RecordedDrawing structure();

 private:
  [[nodiscard]] FrameRecord& recordOf(std::uint32_t index);
  /// Calls into the run, and takes over its status.
  template <class Call>
  void attempt(Call&& call);

  TrackReport report_;
  ExecutorFactory make_host_;
  CancelQuery cancelled_;
  std::optional<CaseRun> run_;  ///< from the first restart() on, for all passes
  bool outdated_ = false;       ///< has to restart before its next use
};

/// All frames that the tracks have run, in the format of FrameTable.
std::string formatFrameTable(const SceneInfo& scene, const std::vector<TrackReport>& tracks);

}  // namespace broadmark
