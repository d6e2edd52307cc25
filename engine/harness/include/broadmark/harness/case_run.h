// Frame-by-frame execution of a case: enforces limits and judges answers.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "broadmark/change_detector.h"
#include "broadmark/harness/case.h"
#include "broadmark/harness/case_executor.h"
#include "broadmark/harness/event_accumulator.h"
#include "broadmark/harness/frame_times.h"
#include "broadmark/harness/oracle.h"
#include "broadmark/harness/status.h"

namespace broadmark {

/// How answers are compared with the oracle's. `full`: as sets. `hash`: by count and hash; as sets
/// on a difference, and always for a conservative algorithm. `off`: not at all.
enum class CheckMode { full, hash, off };

inline constexpr NameTable kCheckModes{
    {NamedValue{CheckMode::full, "full"}, {CheckMode::hash, "hash"}, {CheckMode::off, "off"}}};

/// A run's limits, and how its answers are judged.
struct RunPolicy {
  CheckMode check = CheckMode::full;
  /// Limit on the running mean of a frame's total, judged from the third frame on.
  double frame_limit_seconds = 0.5;
  double initialize_limit_seconds = 60;

  /// Without time limits.
  static RunPolicy unlimited(CheckMode check) {
    constexpr double kNoLimit = std::numeric_limits<double>::infinity();
    return {.check = check, .frame_limit_seconds = kNoLimit, .initialize_limit_seconds = kNoLimit};
  }
};

/// Executes one case in any number of passes, each with a fresh instance in the same host.
///
/// An algorithm's exception becomes the status, and ends the pass; only InputError and Cancelled
/// reach the caller. The end of the host's process is a status, too: the next start() has a new
/// process. Any number of CaseRuns may exist at the same time, on one thread or on several.
///
/// Where the answer is events, CaseRun judges the set of pairs accumulated since the initial pose,
/// and whether each event is possible.
class CaseRun {
 public:
  /// Checks the parameters; start() makes threads and structures. `cancelled` ends waits of the
  /// host. Throws InputError for an invalid parameter.
  explicit CaseRun(Case test_case, RunPolicy policy = {},
                   const ExecutorFactory& make_host = makeLocalHost, CancelQuery cancelled = {});

  [[nodiscard]] const Case& description() const { return case_; }
  /// As BroadPhase::margin().
  [[nodiscard]] float margin() const { return margin_; }
  /// Whether check() judges answers.
  [[nodiscard]] bool checks() const {
    return policy_.check != CheckMode::off && case_.algorithm.traits.finds_pairs;
  }
  /// Disables checks of further answers.
  void stopChecking() { policy_.check = CheckMode::off; }

  /// Begins a pass: a fresh instance at the initial pose. Returns whether it is running: limits of
  /// the processor, the number of bodies or the time become a status. Throws InputError (a device
  /// that does not exist).
  bool start(const SceneInfo& scene, const Frame& first);
  /// Runs the four phases on the next frame and times them. Returns whether the pass still runs: an
  /// exceeded time limit ends it, but the frame counts. Only while running().
  bool step(const Frame& frame);
  /// Judges the answer for this frame, the last one run; nothing unless checks(). Only while
  /// answered().
  std::optional<FrameDifference> check(const Frame& frame, Oracle& oracle);
  /// Ends the pass and frees the instance.
  void stop();

  [[nodiscard]] Status status() const { return status_; }
  [[nodiscard]] const std::string& reason() const { return reason_; }
  /// Whether step() may be called.
  [[nodiscard]] bool running() const { return has_instance_ && !ended_; }
  /// Whether there is an answer: a frame was run, and its instance still exists.
  [[nodiscard]] bool answered() const { return has_instance_ && frames_ > 0; }
  /// False before start(), after stop(), and after a failure inside the algorithm.
  [[nodiscard]] bool hasInstance() const { return has_instance_; }

  // For the present pass, or the last one.
  [[nodiscard]] std::int64_t initializeNanoseconds() const { return initialize_ns_; }
  /// For the last frame.
  [[nodiscard]] const FrameTimes& times() const { return last_.times; }
  [[nodiscard]] std::uint64_t pairs() const { return last_.pairs; }
  /// Bodies that changed in the last frame.
  [[nodiscard]] std::uint64_t changedBodies() const { return changed_count_; }
  /// The host's measurements.
  [[nodiscard]] const PassReport& report() const { return host_->report(); }

  // Queries of the instance, as in CaseExecutor. A failure becomes a status and gives an empty
  // result. Only while hasInstance().
  /// For events: the accumulated pairs, if checks(); else empty.
  PairRuns answer();
  Counts counters();
  Counts setup();
  RecordedDrawing structure();
  std::string validate();

 private:
  /// Calls the host; an exception becomes the status. Returns whether it succeeded.
  template <class Call>
  bool attempt(Call&& call);
  /// The host's answer; empty on failure.
  template <class Answer>
  Answer ask(Answer (CaseExecutor::*question)());
  void fail(Status status, std::string reason);
  [[nodiscard]] bool answersEvents() const { return case_.answer == AnswerKind::events; }
  /// Accumulates the events of this frame, if they are to be judged.
  void followEvents(const Frame& frame);
  [[nodiscard]] std::string atFrame(std::string_view what) const;

  Case case_;
  RunPolicy policy_;
  float margin_ = 0;
  std::unique_ptr<CaseExecutor> host_;
  bool has_instance_ = false;
  bool ended_ = false;        ///< the present pass, by a time limit: its instance still exists
  bool ended_early_ = false;  ///< some pass, by a failure or a limit: see reason_
  Status status_ = Status::ok;
  std::string reason_;
  CollisionFilter filter_;  ///< of the present scene
  ChangeDetector changed_bodies_;
  EventAccumulator followed_;  ///< the pairs that result from the events
  std::uint64_t changed_count_ = 0;
  std::uint32_t frame_ = 0;  ///< index of the frame begun last
  std::int64_t initialize_ns_ = 0;
  StepResult last_;
  std::int64_t total_ns_ = 0;  ///< of all frames in this pass
  std::uint32_t frames_ = 0;   ///< in this pass
};

}  // namespace broadmark
