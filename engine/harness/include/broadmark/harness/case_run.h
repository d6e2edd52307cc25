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

/// The comparison of answers with the oracle's. `full`: as sets. `hash`: by count and hash; as sets
/// on a difference, and always for a conservative algorithm. `off`: not at all.
enum class CheckMode { full, hash, off };

inline constexpr NameTable kCheckModes{
    {NamedValue{CheckMode::full, "full"}, {CheckMode::hash, "hash"}, {CheckMode::off, "off"}}};

/// The limits of a run, and the check of its answers.
struct RunPolicy {
  CheckMode check = CheckMode::full;
  /// Limit on the running mean of a frame's total, judged from the third frame on.
  double frame_limit_seconds = 0.5;
  double initialize_limit_seconds = 60;
  std::uint32_t max_frames = std::numeric_limits<std::uint32_t>::max();  ///< of a pass
  /// If set, instructions are counted instead of times, of cases where that is possible.
  std::optional<CounterSource> counted_by = std::nullopt;

  /// Without time limits.
  static RunPolicy unlimited(CheckMode check) {
    constexpr double kNoLimit = std::numeric_limits<double>::infinity();
    return {.check = check, .frame_limit_seconds = kNoLimit, .initialize_limit_seconds = kNoLimit};
  }
};

/// Executes a case in any number of passes, each with a fresh instance in the same executor.
///
/// An algorithm's exception becomes the status, and ends the pass; only InputError and Cancelled
/// reach the caller. The end of the executor's process is a status, too: the next start() has a new
/// process. Any number of CaseRuns may exist at the same time, on one thread or on several.
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

  [[nodiscard]] const Case& description() const { return case_; }
  /// As BroadPhase::margin().
  [[nodiscard]] float margin() const { return margin_; }
  /// Whether check() checks answers.
  [[nodiscard]] bool checks() const {
    return policy_.check != CheckMode::off && case_.algorithm.traits.finds_pairs;
  }
  /// As RunPolicy::counted_by.
  [[nodiscard]] std::optional<CounterSource> countedBy() const { return policy_.counted_by; }
  /// Disables checks of further answers.
  void stopChecking() { policy_.check = CheckMode::off; }

  /// Starts a pass with a fresh instance at the initial pose. Returns whether the pass is running:
  /// limits of the processor, the number of bodies or the time become a status. Throws InputError
  /// for a nonexistent device.
  bool start(const SceneInfo& scene, const Frame& first);
  /// Runs and times the four phases on the next frame. Returns whether the pass still runs: an
  /// exceeded time limit ends it, but the frame counts. Only while running().
  bool step(const Frame& frame);
  /// Checks the answer for this frame, the last one run; nullopt unless checks(). Only while
  /// answered().
  std::optional<FrameDifference> check(const Frame& frame, Oracle& oracle);
  /// Ends the pass and frees the instance.
  void stop();

  [[nodiscard]] Status status() const { return status_; }
  [[nodiscard]] const std::string& reason() const { return reason_; }
  /// Whether step() may be called.
  [[nodiscard]] bool running() const { return has_instance_ && !ended_; }
  /// Whether there is an answer: a frame has run, and its instance still exists.
  [[nodiscard]] bool answered() const { return has_instance_ && frames_ > 0; }
  /// False before start(), after stop(), and after a failure inside the algorithm.
  [[nodiscard]] bool hasInstance() const { return has_instance_; }

  // For the current pass, or the last one.
  [[nodiscard]] std::int64_t initializeNanoseconds() const { return initialize_ns_; }
  /// For the last frame.
  [[nodiscard]] const FrameTimes& times() const { return last_.times; }
  [[nodiscard]] std::uint64_t pairs() const { return last_.pairs; }
  /// Bodies that changed in the last frame.
  [[nodiscard]] std::uint64_t changedBodies() const { return changed_count_; }
  /// The executor's measurements.
  [[nodiscard]] const PassReport& report() const { return executor_->report(); }

  // Queries of the instance, as in CaseExecutor. A failure becomes a status and yields an empty
  // result. Only while hasInstance().
  /// For events: the accumulated pairs, if checks(); else empty.
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
