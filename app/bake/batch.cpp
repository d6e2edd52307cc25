// A pool of threads that each take the largest waiting job: longest processing time first, which
// finishes at most a third later than the best schedule (Graham 1969).

#include "bake/batch.h"

#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <future>
#include <mutex>
#include <new>
#include <utility>

#include "broadmark/error.h"
#include "broadmark/harness/environment.h"
#include "support/interrupt.h"

namespace broadmark {
namespace {

/// Memory of a simulation per body, including pairs and contacts. Measured with Bullet: 9 kB in
/// FreeFall, 29 kB in Gravity at density 0.5.
constexpr std::uint64_t kBytesPerBody = 32'000;

using Clock = std::chrono::steady_clock;

/// A job with its progress.
struct QueuedJob {
  enum class Phase { waiting, running, finished, stopped };

  explicit QueuedJob(BakeJob bake_job) : job(std::move(bake_job)) {}

  [[nodiscard]] std::uint64_t memory() const { return job.bodies() * kBytesPerBody; }

  BakeJob job;
  std::atomic<std::uint32_t> frame = 0;
  // Below: guarded by the batch's mutex.
  Phase phase = Phase::waiting;
  Clock::time_point begin;
  Clock::time_point end;
};

class Batch {
 public:
  explicit Batch(std::vector<BakeJob> jobs)
      : memory_bytes_(thisEnvironment().memory_bytes / 4 * 3) {
    for (BakeJob& job : jobs) queue_.push_back(std::make_unique<QueuedJob>(std::move(job)));
    std::ranges::stable_sort(queue_, std::ranges::greater{},
                             [](const auto& queued) { return queued->job.work(); });
  }
  ~Batch() { stopping_ = true; }
  Batch(const Batch&) = delete;
  Batch& operator=(const Batch&) = delete;

  void run(int threads, const std::function<void(const BakedJob&)>& on_finished,
           const std::function<bool(const BatchState&)>& progress) {
    constexpr std::chrono::milliseconds kPollInterval{20};
    while (std::cmp_less(threads_.size(), threads) && threads_.size() < queue_.size()) {
      // Deferred, to wait(), if the system grants no more threads.
      threads_.push_back(
          std::async(std::launch::async | std::launch::deferred, [this] { work(); }));
    }
    const auto report = [&] {
      for (const BakedJob& job : takeFinished()) on_finished(job);
      if (!progress(state())) stopping_ = true;
    };
    for (std::future<void>& thread : threads_) {
      while (thread.wait_for(kPollInterval) == std::future_status::timeout) report();
      thread.wait();
      report();
      thread.get();
    }
  }

 private:
  std::vector<BakedJob> takeFinished() {
    const std::lock_guard lock(mutex_);
    return std::exchange(finished_, {});
  }

  BatchState state() {
    const std::lock_guard lock(mutex_);
    BatchState state;
    const auto now = Clock::now();
    std::chrono::duration<double> busy{};
    std::uint64_t longest = 0;
    int running = 0;
    for (const auto& entry : queue_) {
      const QueuedJob& queued = *entry;
      const std::uint64_t work = queued.job.work();
      const std::uint64_t done =
          queued.phase == QueuedJob::Phase::finished ? work : queued.job.bodies() * queued.frame;
      state.total += work;
      state.done += done;
      longest = std::max(longest, work - done);
      if (queued.phase == QueuedJob::Phase::finished) busy += queued.end - queued.begin;
      if (queued.phase != QueuedJob::Phase::running) continue;
      ++running;
      busy += now - queued.begin;
      const SceneInfo& scene = queued.job.scene;
      state.running +=
          fmt::format("{}{} {} N{} frame {}/{}", state.running.empty() ? "" : ", ", scene.name,
                      scene.object_type, scene.objects, queued.frame.load(), scene.frames);
    }
    // Extrapolated: running jobs share the remaining work, but a recording has a single thread.
    const double pace = static_cast<double>(std::max<std::uint64_t>(state.done, 1)) / busy.count();
    const double shared = static_cast<double>(state.total - state.done) / std::max(running, 1);
    state.seconds_left = std::max(shared, static_cast<double>(longest)) / pace;
    return state;
  }

  void work() {
    try {
      while (QueuedJob* queued = nextJob()) bakeJob(*queued);
    } catch (...) {  // an error that concerns the whole batch
      stopping_ = true;
      changed_.notify_all();
      throw;
    }
  }

  /// Waits for a job that fits into memory. Returns null when stopped or without waiting jobs.
  QueuedJob* nextJob() {
    std::unique_lock lock(mutex_);
    while (!stopped()) {
      bool waiting = false;
      for (const auto& queued : queue_) {
        if (queued->phase != QueuedJob::Phase::waiting) continue;
        waiting = true;
        if (!fitsIntoMemory(*queued)) continue;
        queued->phase = QueuedJob::Phase::running;
        queued->begin = Clock::now();
        return queued.get();
      }
      if (!waiting) return nullptr;
      changed_.wait(lock);  // for memory
    }
    return nullptr;
  }

  void bakeJob(QueuedJob& queued) {
    std::string failure;
    bool is_complete = false;
    try {
      is_complete = bake(*queued.job.simulation, queued.job.paths, [&](std::uint32_t frame) {
        queued.frame = frame;
        return !stopped();
      });
    } catch (const InputError& error) {
      failure = error.what();
    } catch (const Cancelled&) {
      stopping_ = true;
    } catch (const std::bad_alloc&) {
      failure = queued.job.paths.front().string() + ": out of memory";
    }
    std::vector<std::string> escapes = escapeTexts(*queued.job.simulation);
    queued.job.simulation.reset();
    const std::lock_guard lock(mutex_);
    const bool finished = is_complete || !failure.empty();
    queued.phase = finished ? QueuedJob::Phase::finished : QueuedJob::Phase::stopped;
    queued.end = Clock::now();
    if (finished) finished_.push_back({queued.job.paths, std::move(failure), std::move(escapes)});
    changed_.notify_all();
  }

  /// Whether there is memory for one more simulation. A single one may always run.
  [[nodiscard]] bool fitsIntoMemory(const QueuedJob& candidate) const {
    std::uint64_t used = 0;
    for (const auto& queued : queue_) {
      if (queued->phase == QueuedJob::Phase::running) used += queued->memory();
    }
    return used == 0 || used + candidate.memory() <= memory_bytes_;
  }

  [[nodiscard]] bool stopped() const { return stopping_ || InterruptGuard::requested(); }

  std::vector<std::unique_ptr<QueuedJob>> queue_;  ///< largest first
  std::uint64_t memory_bytes_;
  std::atomic<bool> stopping_ = false;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<BakedJob> finished_;  ///< guarded by mutex_
  std::vector<std::future<void>> threads_;
};

}  // namespace

void bakeAll(std::vector<BakeJob> jobs, int threads,
             const std::function<void(const BakedJob&)>& on_finished,
             const std::function<bool(const BatchState&)>& progress) {
  Batch(std::move(jobs)).run(threads, on_finished, progress);
}

}  // namespace broadmark
