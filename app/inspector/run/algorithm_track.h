// An inspected algorithm: its case, and its results frame by frame.
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
  bool run = false;  ///< false: the frame has not been run
  bool mismatch = false;
};

/// The frame records of a track as curves.
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
  int build = 0;  ///< number of times that the algorithm's plug-in has been loaded again

  /// Whether both tracks run the same case.
  friend bool operator==(const TrackSpec& a, const TrackSpec& b) {
    return a.number == b.number && a.build == b.build && a.test_case.device == b.test_case.device &&
           caseName(a.test_case) == caseName(b.test_case);
  }
};

/// Position and status of a track.
struct TrackState {
  TrackSpec spec;
  Status status = Status::ok;
  std::string reason;       ///< set unless the status is ok
  bool finished = false;    ///< no more frames are run: too slow, unsupported or failed
  std::uint32_t frame = 0;  ///< last frame run
  std::int64_t initialize_ns = 0;
  float margin = 0;
  std::map<std::string, std::uint64_t> setup;     ///< counters of the initialisation
  std::map<std::string, std::uint64_t> counters;  ///< work counters of the last frame
};

/// The results of a track; a copy stays valid while the track advances.
struct TrackReport : TrackState {
  std::vector<FrameRecord> frames;  ///< frame k at [k - 1]
  TrackCurves curves;               ///< `frames` as curves

  /// Returns the record of a frame, or null if the frame has not been run.
  [[nodiscard]] const FrameRecord* record(std::uint32_t index) const {
    if (index == 0 || index > frames.size() || !frames[index - 1].run) return nullptr;
    return &frames[index - 1];
  }
};

/// Whether the algorithm ended with an error: a crash or an exception.
inline bool hasFailed(const TrackState& track) { return track.status == Status::error; }
/// The frame in which it did; 1 if that was the initial pose.
inline std::uint32_t failedFrame(const TrackState& track) { return track.frame + 1; }

/// Returns the track with this number, or null.
const TrackReport* findTrack(const std::vector<TrackReport>& tracks, int number);

/// Number of frames that took longer than `ms`.
std::uint64_t framesOver(const TrackReport& track, double ms);

/// A running track: a CaseRun that starts another pass when an earlier frame is requested.
class AlgorithmTrack {
 public:
  /// Time limit per frame, on average; exceeding it ends the track.
  static constexpr double kFrameLimitSeconds = 10;

  /// `cancelled` is polled during long calls; if true, they throw Cancelled.
  explicit AlgorithmTrack(TrackSpec spec, ExecutorFactory make_executor = makeInProcessExecutor,
                          CancelQuery cancelled = {})
      : make_executor_(std::move(make_executor)), cancelled_(std::move(cancelled)) {
    report_.spec = std::move(spec);
  }

  [[nodiscard]] const TrackReport& report() const { return report_; }
  [[nodiscard]] const TrackSpec& spec() const { return report_.spec; }
  /// Whether the instance is at this frame: its answer is available, and it can run the next frame
  /// unless it has finished.
  [[nodiscard]] bool isAt(std::uint32_t index) const {
    return run_ && !stale_ && (run_->running() || run_->answered()) && report_.frame == index;
  }

  // These throw only Cancelled: other errors become the status.
  /// Creates a fresh instance at the initial poses, unless the track has finished. Records of later
  /// frames stay until those frames are run again.
  void restart(const SceneInfo& scene, const Frame& first);
  /// Runs the frame after the current one.
  void advance(const Frame& frame, DrawGate& gate);
  /// Compares the current answer with the oracle's; nothing if the algorithm cannot be checked.
  std::optional<FrameDifference> check(const Frame& frame, Oracle& oracle);

  /// Schedules a restart unless all frames run after frame `after` were checked, or the algorithm
  /// cannot be checked.
  void restartUnlessChecked(std::uint32_t after);

  // Precondition: the instance is at a frame, see isAt().
  std::vector<Pair> answer();
  RecordedDrawing structure();

 private:
  [[nodiscard]] FrameRecord& recordOf(std::uint32_t index);
  /// Calls into `run_`, and copies its status or its error to the report.
  template <class Call>
  void callGuarded(Call&& call);

  TrackReport report_;
  ExecutorFactory make_executor_;
  CancelQuery cancelled_;
  std::optional<CaseRun> run_;  ///< created by the first restart(), reused in all passes
  bool stale_ = false;          ///< restart before the next use
};

/// Formats all frames run by the tracks as a FrameTable.
std::string formatFrameTable(const SceneInfo& scene, const std::vector<TrackReport>& tracks);

}  // namespace broadmark
