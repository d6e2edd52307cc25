// A pool of threads that take the largest waiting job: longest processing time first, which ends at
// most a third later than the best schedule (Graham 1969).

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

/// Memory of a simulation per body, pairs and contacts included. Measured with Bullet: 9 kB in
/// FreeFall, 29 kB in Gravity at density 0.5.
constexpr std::uint64_t kBytesPerBody = 32'000;

using Clock = std::chrono::steady_clock;

/// A job with its progress.
struct QueuedJob {
  enum class Phase { waiting, running, ended, stopped };

  explicit QueuedJob(BakeJob what) : job(std::move(what)) {}

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

  void run(int threads, const std::function<void(const BakedJob&)>& ended,
           const std::function<bool(const BatchState&)>& progress) {
    constexpr std::chrono::milliseconds kGlance{20};
    while (std::cmp_less(threads_.size(), threads) && threads_.size() < queue_.size()) {
      threads_.push_back(std::async(std::launch::async, [this] { work(); }));
    }
    for (std::future<void>& thread : threads_) {
      for (bool is_over = false; !is_over;) {
        is_over = thread.wait_for(kGlance) == std::future_status::ready;
        for (const BakedJob& job : takeEnded()) ended(job);
        if (!progress(state())) stopping_ = true;
      }
      thread.get();
    }
  }

 private:
  std::vector<BakedJob> takeEnded() {
    const std::lock_guard lock(mutex_);
    return std::exchange(ended_, {});
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
          queued.phase == QueuedJob::Phase::ended ? work : queued.job.bodies() * queued.frame;
      state.total += work;
      state.done += done;
      longest = std::max(longest, work - done);
      if (queued.phase == QueuedJob::Phase::ended) busy += queued.end - queued.begin;
      if (queued.phase != QueuedJob::Phase::running) continue;
      ++running;
      busy += now - queued.begin;
      const SceneInfo& scene = queued.job.scene;
      state.running +=
          fmt::format("{}{} {} N{} frame {}/{}", state.running.empty() ? "" : ", ", scene.name,
                      scene.object_type, scene.objects, queued.frame.load(), scene.frames);
    }
    // At the pace so far: all that run share what is left, but a recording has one thread.
    const double pace = static_cast<double>(std::max<std::uint64_t>(state.done, 1)) / busy.count();
    const double shared = static_cast<double>(state.total - state.done) / std::max(running, 1);
    state.seconds_left = std::max(shared, static_cast<double>(longest)) / pace;
    return state;
  }

  void work() {
    try {
      while (QueuedJob* queued = take()) perform(*queued);
    } catch (...) {  // an error that concerns the whole batch
      stopping_ = true;
      changed_.notify_all();
      throw;
    }
  }

  QueuedJob* take() {
    std::unique_lock lock(mutex_);
    while (!stopped()) {
      bool waiting = false;
      for (const auto& queued : queue_) {
        if (queued->phase != QueuedJob::Phase::waiting) continue;
        waiting = true;
        if (!fits(*queued)) continue;
        queued->phase = QueuedJob::Phase::running;
        queued->begin = Clock::now();
        return queued.get();
      }
      if (!waiting) return nullptr;
      changed_.wait(lock);  // for memory
    }
    return nullptr;
  }

  void perform(QueuedJob& queued) {
    std::string failure;
    bool whole = false;
    try {
      whole = bake(*queued.job.simulation, queued.job.paths, [&](std::uint32_t frame) {
        queued.frame = frame;
        return !stopped();
      });
    } catch (const InputError& error) {
      failure = error.what();
    } catch (const std::bad_alloc&) {
      failure = queued.job.paths.front().string() + ": out of memory";
    }
    queued.job.simulation.reset();
    const std::lock_guard lock(mutex_);
    const bool ended = whole || !failure.empty();
    queued.phase = ended ? QueuedJob::Phase::ended : QueuedJob::Phase::stopped;
    queued.end = Clock::now();
    if (ended) ended_.push_back({queued.job.paths, std::move(failure)});
    changed_.notify_all();
  }

  /// Whether there is memory for one more simulation. A single one may always queued.
  [[nodiscard]] bool fits(const QueuedJob& candidate) const {
    std::uint64_t taken = 0;
    for (const auto& queued : queue_) {
      if (queued->phase == QueuedJob::Phase::running) taken += queued->memory();
    }
    return taken == 0 || taken + candidate.memory() <= memory_bytes_;
  }

  [[nodiscard]] bool stopped() const { return stopping_ || InterruptGuard::requested(); }

  std::vector<std::unique_ptr<QueuedJob>> queue_;  ///< largest first
  std::uint64_t memory_bytes_;
  std::atomic<bool> stopping_ = false;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<BakedJob> ended_;  ///< guarded by mutex_
  std::vector<std::future<void>> threads_;
};

}  // namespace

void bakeAll(std::vector<BakeJob> jobs, int threads,
             const std::function<void(const BakedJob&)>& ended,
             const std::function<bool(const BatchState&)>& progress) {
  Batch(std::move(jobs)).run(threads, ended, progress);
}

}  // namespace broadmark
