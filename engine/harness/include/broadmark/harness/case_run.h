// A case being run, frame by frame: the one place where limits are kept and answers are judged.
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
/// where these differ, and always for a conservative algorithm. `off`: not at all.
enum class CheckMode { full, hash, off };

inline constexpr NameTable kCheckModes{
    {NamedValue{CheckMode::full, "full"}, {CheckMode::hash, "hash"}, {CheckMode::off, "off"}}};

/// What a run may take, and how its answers are judged.
struct RunPolicy {
  CheckMode check = CheckMode::full;
  /// On the running mean of a frame's total, judged after three frames.
  double frame_limit_seconds = 0.5;
  double initialize_limit_seconds = 60;

  /// Any time will do.
  static RunPolicy unlimited(CheckMode check) {
    constexpr double kNoLimit = std::numeric_limits<double>::infinity();
    return {.check = check, .frame_limit_seconds = kNoLimit, .initialize_limit_seconds = kNoLimit};
  }
};

/// Runs one case, as often as wanted, each pass with a fresh instance in the same host.
///
/// What an algorithm throws becomes the status, and ends the pass; only InputError and Cancelled go
/// on to the caller. So does the end of the host's process: the next start() has a new one. Any
/// number of runs may live at the same time, on one thread or on several.
///
/// Where the answer is events, what is judged is the set of pairs that they have led to since the
/// initial pose, and whether each of them can be.
class CaseRun {
 public:
  /// Checks the parameters; threads and structures are made by start(). `cancelled` ends what the
  /// host would wait for. Throws InputError for a bad parameter.
  explicit CaseRun(Case run, RunPolicy policy = {},
                   const ExecutorFactory& make_host = makeLocalHost, CancelQuery cancelled = {});

  [[nodiscard]] const Case& description() const { return case_; }
  /// As BroadPhase::margin().
  [[nodiscard]] float margin() const { return margin_; }
  /// Whether check() judges answers.
  [[nodiscard]] bool checks() const {
    return policy_.check != CheckMode::off && case_.algorithm.traits.finds_pairs;
  }
  /// Judges no more answers.
  void stopChecking() { policy_.check = CheckMode::off; }

  /// Begins a pass: a fresh instance at the initial pose. Returns whether it is running: what the
  /// processor, the number of bodies or the time limit forbids is a status. Throws InputError (a
  /// device that does not exist).
  bool start(const SceneInfo& scene, const Frame& first);
  /// Runs the four phases on the next frame and times them. Returns whether it is still running: a
  /// time beyond the limit ends the pass, but the frame counts. Only while running().
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
  /// Whether there is an answer: a frame has been run, and its instance is still there.
  [[nodiscard]] bool answered() const { return has_instance_ && frames_ > 0; }
  /// False before start(), after stop(), and after a failure inside the algorithm.
  [[nodiscard]] bool hasInstance() const { return has_instance_; }

  // Of the present pass, or the last one.
  [[nodiscard]] std::int64_t initializeNanoseconds() const { return initialize_ns_; }
  /// Of the last frame.
  [[nodiscard]] const FrameTimes& times() const { return last_.times; }
  [[nodiscard]] std::uint64_t pairs() const { return last_.pairs; }
  /// Bodies that changed in the last frame.
  [[nodiscard]] std::uint64_t changedBodies() const { return changed_count_; }
  /// What its host knows of it.
  [[nodiscard]] const PassReport& report() const { return host_->report(); }

  // What the instance tells of itself, as in CaseExecutor. Empty, and a status, when that fails.
  // Only while hasInstance().
  /// Of events: the pairs that they have led to, if checks(); else empty.
  PairRuns answer();
  Counts counters();
  Counts setup();
  RecordedDrawing structure();
  std::string validate();

 private:
  /// Calls the host; what that throws becomes the status. Whether all went well.
  template <class Call>
  bool attempt(Call&& call);
  /// What the host answers; empty when that fails.
  template <class Answer>
  Answer ask(Answer (CaseExecutor::*question)());
  void fail(Status status, std::string reason);
  [[nodiscard]] bool answersEvents() const { return case_.answer == AnswerKind::events; }
  /// Takes the events of this frame into account, if they are to be judged.
  void followEvents(const Frame& frame);
  [[nodiscard]] std::string atFrame(std::string_view what) const;

  Case case_;
  RunPolicy policy_;
  float margin_ = 0;
  std::unique_ptr<CaseExecutor> host_;
  bool has_instance_ = false;
  bool ended_ = false;        ///< the present pass, by a time limit: its instance is still there
  bool ended_early_ = false;  ///< some pass, by a failure or a limit: reason_ says which
  Status status_ = Status::ok;
  std::string reason_;
  CollisionFilter filter_;  ///< of the present scene
  ChangeDetector changed_bodies_;
  EventAccumulator followed_;  ///< what events have led to
  std::uint64_t changed_count_ = 0;
  std::uint32_t frame_ = 0;  ///< that was begun last
  std::int64_t initialize_ns_ = 0;
  StepResult last_;
  std::int64_t total_ns_ = 0;  ///< of all frames in this pass
  std::uint32_t frames_ = 0;   ///< in this pass
};

}  // namespace broadmark
