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

/// What one frame gave.
struct FrameRecord : FrameRow {
  bool run = false;  ///< false: nothing is known of this frame
  bool mismatch = false;
};

/// The records of a lane as curves.
struct LaneCurves {
  std::array<FrameValues, kPhases.entries.size()> seconds;  ///< by phase
  FrameValues pairs;
  FrameValues disturbed;   ///< 1 in such frames, unknown in others
  FrameValues mismatches;  ///< likewise

  void set(std::uint32_t frame, const FrameRecord& record);
};

/// A case that is looked at. The number tells apart two that are otherwise alike.
struct LaneSpec {
  int number = 0;
  Case run;

  /// Whether both would do the same.
  friend bool operator==(const LaneSpec& a, const LaneSpec& b) {
    return a.number == b.number && a.run.device == b.run.device &&
           caseName(a.run) == caseName(b.run);
  }
};

/// Where a lane is, and how it fares.
struct LaneState {
  LaneSpec spec;
  Status status = Status::ok;
  std::string reason;       ///< for every status but ok
  bool ended = false;       ///< it is not run any more: too slow, unsupported or broken
  std::uint32_t frame = 0;  ///< up to which it has come
  std::int64_t initialize_ns = 0;
  float margin = 0;
  std::map<std::string, std::uint64_t> setup;     ///< counted once, in the initialisation
  std::map<std::string, std::uint64_t> counters;  ///< of work, in the last frame
};

/// What is known of a lane; a copy of it can be looked at while the lane works on.
struct LaneReport : LaneState {
  std::vector<FrameRecord> frames;  ///< frame k at [k - 1]
  LaneCurves curves;                ///< of these

  /// The record of a frame, or null when nothing is known of it.
  [[nodiscard]] const FrameRecord* record(std::uint32_t index) const {
    if (index == 0 || index > frames.size() || !frames[index - 1].run) return nullptr;
    return &frames[index - 1];
  }
};

/// The lane of this number, or null.
const LaneReport* laneOf(const std::vector<LaneReport>& lanes, int number);

/// How many of the frames took longer.
std::uint64_t framesOver(const LaneReport& lane, double ms);

/// The running lane: a CaseRun, which begins another pass when an earlier frame is wanted.
class AlgorithmTrack {
 public:
  /// A frame that takes longer, on average, ends the lane.
  static constexpr double kFrameLimitSeconds = 10;

  /// `cancelled` ends what it waits for; the call then throws Cancelled.
  explicit AlgorithmTrack(LaneSpec spec, ExecutorFactory make_host = makeLocalHost,
                          CancelQuery cancelled = {})
      : make_host_(std::move(make_host)), cancelled_(std::move(cancelled)) {
    report_.spec = std::move(spec);
  }

  [[nodiscard]] const LaneReport& report() const { return report_; }
  [[nodiscard]] const LaneSpec& spec() const { return report_.spec; }
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

  /// Has it begin anew unless all frames that it has run after this one were checked, as far as it
  /// can be.
  void requireChecked(std::uint32_t after);

  // Only while standsAt() some frame.
  std::vector<Pair> answer();
  RecordedDrawing structure();

 private:
  [[nodiscard]] FrameRecord& recordOf(std::uint32_t index);
  /// Calls into the run, and takes over its status.
  template <class Call>
  void attempt(Call&& call);

  LaneReport report_;
  ExecutorFactory make_host_;
  CancelQuery cancelled_;
  std::optional<CaseRun> run_;  ///< from the first restart() on, for all passes
  bool outdated_ = false;       ///< it has to begin anew before it is used
};

/// Of each lane every frame that has been run, as FrameTable writes it.
std::string formatFrameTable(const SceneInfo& scene, const std::vector<LaneReport>& lanes);

}  // namespace broadmark
