// A pool of threads that take the largest waiting job: longest processing time first, which ends at
// most a third later than the best schedule (Graham 1969).

#include "bake/batch.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
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

}  // namespace

/// A job with its progress.
struct BakeBatch::Run {
  enum class Phase { waiting, running, ended, stopped };

  explicit Run(BakeJob what) : job(std::move(what)) {}

  [[nodiscard]] std::uint64_t bodies() const { return std::max(job.scene.objects, 1U); }
  [[nodiscard]] std::uint64_t work() const { return bodies() * job.scene.frames; }
  [[nodiscard]] std::uint64_t done() const { return bodies() * frame; }
  [[nodiscard]] std::uint64_t memory() const { return bodies() * kBytesPerBody; }

  BakeJob job;
  std::atomic<std::uint32_t> frame = 0;
  // Below: guarded by the batch's mutex.
  Phase phase = Phase::waiting;
  Clock::time_point begin;
  Clock::time_point end;
};

BakeBatch::BakeBatch(std::vector<BakeJob> jobs, int threads)
    : memory_bytes_(thisEnvironment().memory_bytes / 4 * 3),
      active_threads_(std::min(static_cast<std::size_t>(threads), jobs.size())) {
  for (BakeJob& job : jobs) runs_.push_back(std::make_unique<Run>(std::move(job)));
  std::ranges::stable_sort(runs_, std::ranges::greater{},
                           [](const auto& run) { return run->work(); });
  threads_.reserve(active_threads_);
  try {
    for (std::size_t i = active_threads_; i > 0; --i) threads_.emplace_back([this] { work(); });
  } catch (...) {  // no more threads available
    stopping_ = true;
    for (std::thread& thread : threads_) thread.join();
    throw;
  }
}

BakeBatch::~BakeBatch() {
  cancel();
  for (std::thread& thread : threads_) thread.join();
}

std::vector<BakedJob> BakeBatch::await(std::chrono::milliseconds patience) {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, patience, [this] { return !ended_.empty() || active_threads_ == 0; });
  if (broken_) std::rethrow_exception(broken_);
  return std::exchange(ended_, {});
}

void BakeBatch::cancel() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
}

bool BakeBatch::ended() {
  const std::lock_guard lock(mutex_);
  return active_threads_ == 0 && ended_.empty();
}

BatchState BakeBatch::state() {
  const std::lock_guard lock(mutex_);
  BatchState state;
  const auto now = Clock::now();
  std::chrono::duration<double> busy{};
  std::uint64_t longest = 0;
  for (const auto& each : runs_) {
    const Run& run = *each;
    const std::uint64_t done = run.phase == Run::Phase::ended ? run.work() : run.done();
    state.total += run.work();
    state.done += done;
    longest = std::max(longest, run.work() - done);
    if (run.phase == Run::Phase::ended) busy += run.end - run.begin;
    if (run.phase != Run::Phase::running) continue;
    busy += now - run.begin;
    const SceneInfo& scene = run.job.scene;
    state.running +=
        fmt::format("{}{} {} N{} frame {}/{}", state.running.empty() ? "" : ", ", scene.name,
                    scene.object_type, scene.objects, run.frame.load(), scene.frames);
  }
  // At the pace so far: all threads share what is left, but a recording has one thread.
  const double pace = static_cast<double>(std::max<std::uint64_t>(state.done, 1)) / busy.count();
  const double shared = static_cast<double>(state.total - state.done) /
                        static_cast<double>(std::max<std::size_t>(active_threads_, 1));
  state.seconds_left = std::max(shared, static_cast<double>(longest)) / pace;
  return state;
}

void BakeBatch::work() {
  try {
    while (Run* run = take()) perform(*run);
  } catch (...) {
    stopping_ = true;
    const std::lock_guard lock(mutex_);
    if (!broken_) broken_ = std::current_exception();
  }
  const std::lock_guard lock(mutex_);
  --active_threads_;
  changed_.notify_all();
}

BakeBatch::Run* BakeBatch::take() {
  std::unique_lock lock(mutex_);
  while (!stopped()) {
    bool waiting = false;
    for (const auto& run : runs_) {
      if (run->phase != Run::Phase::waiting) continue;
      waiting = true;
      if (!fits(*run)) continue;
      run->phase = Run::Phase::running;
      run->begin = Clock::now();
      return run.get();
    }
    if (!waiting) return nullptr;
    changed_.wait(lock);  // for memory
  }
  return nullptr;
}

void BakeBatch::perform(Run& run) {
  std::string failure;
  bool whole = false;
  try {
    whole = bake(*run.job.simulation, run.job.paths, [&](std::uint32_t frame) {
      run.frame = frame;
      return !stopped();
    });
  } catch (const InputError& error) {
    failure = error.what();
  } catch (const std::bad_alloc&) {
    failure = run.job.paths.front().string() + ": out of memory";
  }
  run.job.simulation.reset();
  const std::lock_guard lock(mutex_);
  const bool ended = whole || !failure.empty();
  run.phase = ended ? Run::Phase::ended : Run::Phase::stopped;
  run.end = Clock::now();
  if (ended) ended_.push_back({run.job.paths, std::move(failure)});
  changed_.notify_all();
}

/// Whether there is memory for one more simulation. A single one may always run.
bool BakeBatch::fits(const Run& candidate) const {
  std::uint64_t taken = 0;
  for (const auto& run : runs_) {
    if (run->phase == Run::Phase::running) taken += run->memory();
  }
  return taken == 0 || taken + candidate.memory() <= memory_bytes_;
}

bool BakeBatch::stopped() const { return stopping_ || InterruptGuard::requested(); }

}  // namespace broadmark
