// An algorithm under observation: the case, its instance, and what it has done frame by frame.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "inspector/draw_gate.h"
#include "broadmark/runner.h"

namespace broadmark {

/// What one frame gave.
struct FrameRecord {
  FrameTimes times;
  std::uint64_t pairs = 0;
  std::uint64_t missed = 0;
  std::uint64_t extra = 0;
  bool run = false;        ///< false: nothing is known of this frame
  bool disturbed = false;  ///< something was drawn while it was timed
  bool checked = false;
  bool mismatch = false;  ///< wrong beyond the algorithm's margin
};

/// A case that is looked at. The number tells apart two that are otherwise alike.
struct LaneSpec {
  int number = 0;
  Case run;

  /// Whether both would do the same.
  [[nodiscard]] bool same(const LaneSpec& other) const {
    return number == other.number && run.device == other.run.device &&
           caseName(run) == caseName(other.run);
  }
};

/// What is known of a lane; a copy of it can be looked at while the lane works on.
struct LaneReport {
  LaneSpec spec;
  Status status = Status::ok;  ///< timeout, unsupported and error: it is not run any more
  std::string reason;
  std::uint32_t frame = 0;  ///< up to which it has come
  std::int64_t initialize_ns = 0;
  float margin = 0;
  std::vector<FrameRecord> frames;                ///< frame k at [k - 1]
  std::map<std::string, std::uint64_t> counters;  ///< of work, in the last frame

  [[nodiscard]] bool runs() const { return status == Status::ok || status == Status::mismatch; }
  /// The record of a frame, or null when nothing is known of it.
  [[nodiscard]] const FrameRecord* record(std::uint32_t index) const {
    if (index == 0 || index > frames.size() || !frames[index - 1].run) return nullptr;
    return &frames[index - 1];
  }
};

/// The running lane.
class Lane {
 public:
  /// A frame that takes longer, on average, ends the lane.
  static constexpr double kFrameLimitSeconds = 10;

  explicit Lane(LaneSpec spec) { report_.spec = std::move(spec); }

  [[nodiscard]] const LaneReport& report() const { return report_; }
  [[nodiscard]] const LaneSpec& spec() const { return report_.spec; }
  /// Whether it could run the frame after `index` next.
  [[nodiscard]] bool standsAt(std::uint32_t index) const {
    return instance_ != nullptr && report_.frame == index;
  }

  /// A fresh instance, at the initial pose. What was recorded of later frames stays until they are
  /// run again. Never throws: a failure becomes the status.
  void restart(const SceneInfo& scene, const Frame& first);
  /// Frees the instance.
  void stop() { instance_.reset(); }
  void fail(Status status, std::string reason);
  /// Runs the frame after the present one.
  void advance(const Frame& frame, DrawGate& gate);
  /// Compares the present answer with the right one.
  FrameDifference check(const Frame& frame, Oracle& oracle);

  /// Only while runs() and after restart().
  [[nodiscard]] const BroadPhase& algorithm() const { return instance_->algorithm(); }

 private:
  [[nodiscard]] FrameRecord& recordOf(std::uint32_t index);

  LaneReport report_;
  std::unique_ptr<CaseInstance> instance_;
  double seconds_ = 0;  ///< in frames since the restart
};

}  // namespace broadmark
