// Executors create, call and time a case's instance: in this process, or in a worker process
// (worker_process.h). CaseRun judges the results and does not distinguish them.
//
// Example:
//
//   const auto searchNanoseconds = [](const Case& test_case, FrameSource& frames) {
//     InProcessExecutor executor(test_case);
//     executor.start(frames.scene(), frames.rewind());
//     const StepResult first = executor.step(*frames.next());  // lists its changes
//     const PairRuns pairs = executor.answer();
//     return first.times[Phase::search_overlaps];
//   };
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "broadmark/error.h"
#include "broadmark/harness/case.h"
#include "broadmark/harness/frame_times.h"
#include "broadmark/harness/oracle.h"
#include "broadmark/harness/processor_counters.h"
#include "broadmark/recorded_drawing.h"

namespace broadmark {

/// An algorithm's counters, by name. See BroadPhase::visitCounters() and visitSetup().
using Counts = std::map<std::string, std::uint64_t>;

/// The result of running one frame.
struct StepResult {
  FrameTimes times;  ///< nanoseconds
  /// In the answer, duplicates included; or the number of events, or of the queries' hits.
  std::uint64_t pairs = 0;
};

/// Measurements of an executor's passes; no memory if its process has other work.
struct PassReport {
  std::optional<std::uint64_t> heap_bytes;  ///< allocated and not freed after the last stop()
  std::optional<std::uint64_t> peak_bytes;  ///< growth of peak memory by the first pass
  /// Growth of the process's private memory from start() to the last counters().
  std::optional<std::uint64_t> private_bytes;
  ProcessorCounts processor;  ///< over the four phases of all frames; empty before stop()
  bool pinned = false;        ///< each thread was bound to its own core
};

/// Holds at most one instance of a case's algorithm, and calls it. Frames must list their changes
/// (Frame::changed; ChangeDetector adds them), and need to be valid only during the call. All calls
/// must come from one thread at a time.
///
/// Every call forwards the algorithm's exceptions. An executor in another process also throws
/// HostError when that process ended, HardLimitError when a call took too long, and Cancelled; then
/// the instance no longer exists.
class CaseExecutor {
 public:
  virtual ~CaseExecutor() = default;

  /// Creates an instance at the initial pose, instead of the present one, if any. Returns the
  /// duration of BroadPhase::initialize() in nanoseconds. Throws UnsupportedError for limits of the
  /// processor, the number of bodies, or the algorithm's support of absent bodies, filters and
  /// queries, and InputError for a device that does not exist.
  virtual std::int64_t start(const SceneInfo& scene, const Frame& first) = 0;
  /// Runs the four phases on the next frame, and stores its answer. Only between start() and
  /// stop().
  virtual StepResult step(const Frame& frame) = 0;
  /// Destroys the instance, if any.
  virtual void stop() = 0;

  // For the last frame. Only between start() and stop(). The first two require an
  // answer of pairs or queries, the third one of events, which exist for the initial pose, too.

  /// The digest of answer(). O(pairs), but nothing is copied between processes.
  virtual PairDigest digest() = 0;
  /// As BroadPhase::overlaps(). Valid until the next call.
  virtual PairRuns answer() = 0;
  /// As BroadPhase::events(). Valid until the next call.
  virtual PairEvents events() = 0;
  /// As BroadPhase::visitCounters(); sums over the instances, if each world has its own.
  virtual Counts counters() = 0;
  /// As BroadPhase::visitSetup(): the counters of start(), whatever the frame.
  virtual Counts setup() = 0;
  /// As BroadPhase::drawStructure(), up to RecordedDrawing::kMaxItems items of a kind.
  virtual RecordedDrawing structure() = 0;
  /// As BroadPhase::validate().
  virtual std::string validate() = 0;

  /// For the last pass.
  [[nodiscard]] const PassReport& report() const { return report_; }

 protected:
  PassReport report_;
};

/// An executor in this process. All passes share one ExecutionContext: threads, a device's context
/// and its kernels are created once, by the first start(). Its processor counters count that call's
/// thread and the threads created by it. Calls that initialise, run, validate or destroy the
/// instance hold its traits' exclusive use; the wait for that is not timed. Memory is not measured.
class InProcessExecutor final : public CaseExecutor {
 public:
  /// With `pin`, binds each of the case's threads, the calling thread included, to its own core,
  /// chosen again for every pass; unless there are too few cores, or a device's driver has threads,
  /// too. The calling thread remains bound: for a process without other work.
  explicit InProcessExecutor(Case test_case, bool pin = false,
                             CounterSource counters = CounterSource::processor)
      : case_(std::move(test_case)), pin_(pin), counter_source_(counters) {}
  ~InProcessExecutor() override;
  InProcessExecutor(const InProcessExecutor&) = delete;
  InProcessExecutor& operator=(const InProcessExecutor&) = delete;

  /// The case given to the constructor.
  [[nodiscard]] const Case& testCase() const { return case_; }
  std::int64_t start(const SceneInfo& scene, const Frame& first) override;
  StepResult step(const Frame& frame) override;
  void stop() override;
  PairDigest digest() override { return broadmark::digest(answer_); }
  PairRuns answer() override { return answer_; }
  PairEvents events() override { return events_; }
  Counts counters() override;
  Counts setup() override;
  RecordedDrawing structure() override;
  std::string validate() override;

  /// The instance, for calls of single phases in tests. Only between start() and stop().
  BroadPhase& instance() { return *instance_; }

 private:
  FrameTimes runCounted(const Frame& frame);
  std::unique_ptr<BroadPhase> makeInstanceFor(const SceneInfo& scene) const;
  std::uint64_t storeAnswer();
  void pinThreads();

  Case case_;
  bool pin_;
  CounterSource counter_source_;
  std::vector<int> usable_cores_;  ///< before pinning
  // Set by the first start(). Counters come first: they count threads started after them.
  std::optional<ProcessorCounters> processor_;
  std::optional<ExecutionContext> execution_;
  std::unique_ptr<BroadPhase> instance_;
  std::uint32_t bodies_ = 0;    ///< number of bodies in the scene
  std::vector<Query> queries_;  ///< of this frame
  PairRuns answer_;
  PairEvents events_;
};

/// Creates the executor of a case. An executor with long waits throws Cancelled soon after
/// `cancelled` returns true.
using ExecutorFactory =
    std::function<std::unique_ptr<CaseExecutor>(const Case&, CancelQuery cancelled)>;

/// Creates an InProcessExecutor, unpinned, which cannot be cancelled: an ExecutorFactory.
std::unique_ptr<CaseExecutor> makeInProcessExecutor(const Case&, CancelQuery);

}  // namespace broadmark
