// Where a case's instance lives, is called and is timed: in this process, or in a worker process
// (worker_process.h). CaseRun judges what comes of it, and does not know which.
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

/// What an algorithm counted, by name.
using Counts = std::map<std::string, std::uint64_t>;

/// What running one frame gave.
struct StepResult {
  FrameTimes times;
  std::uint64_t pairs = 0;  ///< in the answer, duplicates included; of events all that there are
};

/// Measurements of a host's passes; those of memory are missing where its process has other work.
struct PassReport {
  std::optional<std::uint64_t> heap_bytes;  ///< allocated and not freed after the last stop()
  std::optional<std::uint64_t> peak_bytes;  ///< growth of the peak of memory by the first pass
  ProcessorCounts processor;  ///< of the four phases of all frames; nothing before stop()
  bool pinned = false;        ///< each thread had a core of its own, to which it was bound
};

/// Holds at most one instance of a case's algorithm, and calls it. Its frames say what changed.
///
/// Every call throws what the algorithm throws. A host outside this process also throws HostError
/// when that ended, HardLimitError when a call took too long, and Cancelled; then the instance is
/// gone.
class CaseExecutor {
 public:
  virtual ~CaseExecutor() = default;

  /// Makes a fresh instance at the initial pose. Returns how long it took to initialise, in
  /// nanoseconds. Throws UnsupportedError for what the processor or the number of bodies forbids,
  /// and InputError for a device that does not exist.
  virtual std::int64_t start(const SceneInfo& scene, const Frame& first) = 0;
  /// Runs the four phases on the next frame.
  virtual StepResult step(const Frame& frame) = 0;
  /// Frees the instance, if there is one.
  virtual void stop() = 0;

  // Of the frame that was run last. Only between start() and stop().
  // The first two where the case's answer is pairs, the third where it is events: these are there
  // for the initial pose, too.
  virtual PairDigest digest() = 0;
  /// Valid until the next call.
  virtual PairRuns answer() = 0;
  /// Valid until the next call.
  virtual PairEvents events() = 0;
  virtual Counts counters() = 0;
  virtual Counts setup() = 0;
  virtual RecordedDrawing structure() = 0;
  /// As BroadPhase::validate().
  virtual std::string validate() = 0;

  /// Of the last pass.
  [[nodiscard]] const PassReport& report() const { return report_; }

 protected:
  PassReport report_;
};

/// A host in this process. All passes share one Execution: threads, a device's context and its
/// kernels are made once. Every call into the algorithm holds its traits' exclusive use; waiting
/// for that is not timed.
class InProcessExecutor final : public CaseExecutor {
 public:
  /// With `pin`, each of the case's threads is bound to a core of its own, chosen anew for every
  /// pass; unless they are more than the cores, or a device's driver has threads, too. That goes
  /// for the calling thread as well, which so stays: for a process that does nothing else.
  explicit InProcessExecutor(Case run, bool pin = false) : case_(std::move(run)), pin_(pin) {}
  ~InProcessExecutor() override;
  InProcessExecutor(const InProcessExecutor&) = delete;
  InProcessExecutor& operator=(const InProcessExecutor&) = delete;

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

  /// The instance: to call its phases one by one, as tests do. Only between start() and stop().
  BroadPhase& instance() { return *instance_; }

 private:
  FrameTimes runCounted(const Frame& frame);
  std::unique_ptr<BroadPhase> makeInstanceFor(const SceneInfo& scene) const;
  std::uint64_t takeAnswer();
  void pinThreads();

  Case case_;
  bool pin_;
  std::vector<int> usable_cores_;  ///< before any thread was pinned
  // From the first start() on. The counters come first: they count the threads made after them.
  std::optional<ProcessorCounters> processor_;
  std::optional<ExecutionContext> execution_;
  std::unique_ptr<BroadPhase> instance_;
  std::uint32_t bodies_ = 0;  ///< of its scene
  PairRuns answer_;
  PairEvents events_;
};

/// Asked now and then during long work; true ends it.
using CancelQuery = std::function<bool()>;

/// Makes the host of a case. A host that may wait for long gives up, and throws Cancelled, soon
/// after `cancelled` is true.
using ExecutorFactory =
    std::function<std::unique_ptr<CaseExecutor>(const Case&, CancelQuery cancelled)>;

/// Hosts in this process, which cannot be cancelled.
std::unique_ptr<CaseExecutor> makeLocalHost(const Case&, CancelQuery);

}  // namespace broadmark
