// Frame-by-frame execution of a case: enforces limits and judges answers.
//
// Example:
//
//   const auto passes = [](const Algorithm& algorithm, FrameSource& frames) {
//     CaseRun run({.algorithm = algorithm}, RunPolicy::unlimited(CheckMode::full));
//     Oracle oracle;
//     run.start(frames.scene(), frames.rewind());
//     for (auto frame = frames.next(); frame && run.running(); frame = frames.next()) {
//       if (run.step(*frame)) run.check(*frame, oracle);
//     }
//     return run.status() == Status::ok;  // else run.reason() states the cause
//   };
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

/// The comparison of answers with the oracle's. `full`: as sets. `hash`: by count and hash; as sets
/// on a difference, and always for a conservative algorithm. `off`: not at all.
enum class CheckMode { full, hash, off };

inline constexpr NameTable kCheckModes{
    {NamedValue{CheckMode::full, "full"}, {CheckMode::hash, "hash"}, {CheckMode::off, "off"}}};

/// The limits of a run, and the check of its answers. Limits are compared after a call: they do not
/// interrupt it.
struct RunPolicy {
  CheckMode check = CheckMode::full;
  /// Limit on the running mean of a frame's total, judged from the third frame on.
  double frame_limit_seconds = 0.5;
  double initialize_limit_seconds = 60;
  /// A pass ends after this many frames beyond the initial pose, still ok; at least one runs.
  std::uint32_t max_frames = std::numeric_limits<std::uint32_t>::max();
  /// If set, the run counts instructions instead of times: cases with several threads or a device
  /// become `unsupported`. The executor must have the same CounterSource.
  std::optional<CounterSource> counted_by = std::nullopt;

  /// Without time limits, for any number of frames.
  static RunPolicy unlimited(CheckMode check) {
    constexpr double kNoLimit = std::numeric_limits<double>::infinity();
    return {.check = check, .frame_limit_seconds = kNoLimit, .initialize_limit_seconds = kNoLimit};
  }
};

/// Executes a case in any number of passes, each with a fresh instance in the same executor.
///
/// An algorithm's exception becomes the status, and ends the pass; only its InputError and
/// Cancelled reach the caller, after the end of the pass. The end of the executor's process is a
/// status, too: the next start() has a new process. Any number of CaseRuns may exist at the same
/// time, on one thread or on several; each is used by one thread at a time.
///
/// If the answer is events, CaseRun checks the set of pairs accumulated since the initial pose,
/// and that each event is possible.
class CaseRun {
 public:
  /// Checks the parameters; start() creates threads and structures. `cancelled` ends waits of the
  /// executor. Throws InputError for an invalid parameter.
  explicit CaseRun(Case test_case, RunPolicy policy = {},
                   const ExecutorFactory& make_executor = makeInProcessExecutor,
                   CancelQuery cancelled = {});

  /// The case given to the constructor.
  [[nodiscard]] const Case& description() const { return case_; }
  /// As BroadPhase::margin(), in world units.
  [[nodiscard]] float margin() const { return margin_; }
  /// Whether check() checks answers.
  [[nodiscard]] bool checks() const {
    return policy_.check != CheckMode::off && case_.algorithm.traits.finds_pairs;
  }
  /// As RunPolicy::counted_by.
  [[nodiscard]] std::optional<CounterSource> countedBy() const { return policy_.counted_by; }
  /// Disables checks of further answers.
  void stopChecking() { policy_.check = CheckMode::off; }

  /// Starts a pass with a fresh instance at the initial pose, frame 0, after stop(). Returns
  /// whether the pass is running: limits of the processor, the number of bodies or the time become
  /// a status. Throws InputError for a nonexistent device. Copies the scene, and the boxes unless
  /// the frame lists its changes.
  bool start(const SceneInfo& scene, const Frame& first);
  /// Runs and times the four phases on the next frame. Returns whether the pass still runs: an
  /// exceeded time limit or RunPolicy::max_frames ends it, but the frame counts and has an answer;
  /// a failure inside the algorithm leaves none. Only while running(). O(bodies) besides the
  /// algorithm's work, unless the frame lists its changes.
  bool step(const Frame& frame);
  /// Checks the answer for this frame, the last one run; a mismatch becomes the status, and the
  /// pass runs on. Nullopt unless checks(), or if the executor fails to deliver the answer. Throws
  /// as the oracle. Only while answered().
  std::optional<FrameDifference> check(const Frame& frame, Oracle& oracle);
  /// Ends the pass, if any, and frees the instance.
  void stop();

  /// The first status but ok of all passes: start() does not reset it.
  [[nodiscard]] Status status() const { return status_; }
  /// The cause; after a mismatch also that of the first failure. "" while ok.
  [[nodiscard]] const std::string& reason() const { return reason_; }
  /// Whether step() may be called.
  [[nodiscard]] bool running() const { return has_instance_ && !ended_; }
  /// Whether there is an answer: a frame has run, and its instance still exists.
  [[nodiscard]] bool answered() const { return has_instance_ && frames_ > 0; }
  /// False before start(), after stop(), and after a failure inside the algorithm.
  [[nodiscard]] bool hasInstance() const { return has_instance_; }

  // For the current pass, or the last one.

  /// 0 if the instance could not be initialised.
  [[nodiscard]] std::int64_t initializeNanoseconds() const { return initialize_ns_; }
  /// For the last frame run.
  [[nodiscard]] const FrameTimes& times() const { return last_.times; }
  /// As StepResult::pairs, for the last frame run.
  [[nodiscard]] std::uint64_t pairs() const { return last_.pairs; }
  /// The number of bodies that changed in the last frame, as Frame::changed.
  [[nodiscard]] std::uint64_t changedBodies() const { return changed_count_; }
  /// The executor's measurements, complete after stop().
  [[nodiscard]] const PassReport& report() const { return executor_->report(); }

  // Queries of the instance, as in CaseExecutor. A failure becomes a status and yields an empty
  // result. Only while hasInstance().
  /// For events: the accumulated pairs, ascending, if checks(); else empty. Valid until the next
  /// call.
  PairRuns answer();
  Counts counters();
  Counts setup();
  RecordedDrawing structure();
  std::string validate();

 private:
  /// Calls the executor; an exception becomes the status. Returns whether the call succeeded.
  template <class Call>
  bool attempt(Call&& call);
  /// The executor's result; empty on failure.
  template <class Answer>
  Answer query(Answer (CaseExecutor::*method)());
  void fail(Status status, std::string reason);
  [[nodiscard]] bool answersEvents() const { return case_.answer == AnswerKind::events; }
  /// Accumulates the events of this frame, if they are checked.
  void accumulateEvents(const Frame& frame);
  /// As check(), of an answer to queries.
  std::optional<FrameDifference> checkHits(const Frame& frame, Oracle& oracle);
  [[nodiscard]] std::string atFrame(std::string_view what) const;

  Case case_;
  RunPolicy policy_;
  float margin_ = 0;
  std::unique_ptr<CaseExecutor> executor_;
  bool has_instance_ = false;
  bool ended_ = false;   ///< a limit ended the current pass: its instance still exists
  bool failed_ = false;  ///< a failure or a limit ended some pass: see reason_
  Status status_ = Status::ok;
  std::string reason_;
  SceneInfo scene_;  ///< the current one
  ChangeDetector change_detector_;
  EventAccumulator accumulated_;  ///< the pairs that result from the events
  std::uint64_t changed_count_ = 0;
  std::uint32_t frame_ = 0;  ///< index of the last frame started
  std::int64_t initialize_ns_ = 0;
  StepResult last_;
  std::int64_t total_ns_ = 0;  ///< of all frames in this pass
  std::uint32_t frames_ = 0;   ///< in this pass
};

}  // namespace broadmark
