// Instruction sets of this processor, and a fixed team of threads.

#include "broadmark/execution.h"

#include <pthread.h>
#include <sched.h>

#include <algorithm>
#include <system_error>

#include "broadmark/cores.h"

namespace broadmark {
namespace {

/// Spins before a waiting thread sleeps: about 20 µs, since a frame of a small scene is shorter
/// than a wake-up. Pointless when threads outnumber the cores.
constexpr int kSpins = 2000;

/// Spins after wake(), which announces work.
constexpr int kHotSpinCount = 50'000;

/// Hints to the processor that this thread spins.
void pauseSpin() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#elif defined(__aarch64__)
  __asm__ volatile("isb");  // takes about as long as x86's pause; "yield" takes no time
#endif
}

/// Waits until `value` differs from `old`; returns the new value.
template <class T>
T awaitChange(const std::atomic<T>& value, T old, int spins) {
  for (int spin = 0; spin < spins; ++spin) {
    const T now = value.load(std::memory_order_acquire);
    if (now != old) return now;
    pauseSpin();
  }
  value.wait(old, std::memory_order_acquire);
  return value.load(std::memory_order_acquire);
}

/// Binds a thread to these cores except `excluded`. Returns whether the system allowed the binding.
bool bind(pthread_t thread, std::span<const int> cores, int excluded = -1) {
  cpu_set_t set;
  CPU_ZERO(&set);
  for (const int core : cores) {
    if (core != excluded) CPU_SET(core, &set);
  }
  return ::pthread_setaffinity_np(thread, sizeof set, &set) == 0;
}

}  // namespace

std::vector<int> usableCores() {
  std::vector<int> cores;
  cpu_set_t set;
  CPU_ZERO(&set);
  if (::sched_getaffinity(0, sizeof set, &set) != 0) return {0};
  for (int core = 0; core < CPU_SETSIZE; ++core) {
    if (CPU_ISSET(core, &set)) cores.push_back(core);
  }
  return cores;
}

bool isaSupported(Isa isa) {
  switch (isa) {
    case Isa::scalar:
      return true;
#if defined(__x86_64__)
    case Isa::sse2:
      return __builtin_cpu_supports("sse2") != 0;
    case Isa::avx2:
      return __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("bmi") != 0 &&
             __builtin_cpu_supports("popcnt") != 0;
    case Isa::avx512:
      return isaSupported(Isa::avx2) && __builtin_cpu_supports("avx512f") != 0 &&
             __builtin_cpu_supports("avx512bw") != 0 && __builtin_cpu_supports("avx512dq") != 0 &&
             __builtin_cpu_supports("avx512vl") != 0 && __builtin_cpu_supports("avx512cd") != 0 &&
             __builtin_cpu_supports("bmi2") != 0;
#elif defined(__aarch64__)
    case Isa::neon:
      return true;  // part of the baseline
#elif defined(__wasm_simd128__)
    case Isa::simd128:
      return true;  // the program would not start without
#endif
    default:
      return false;
  }
}

std::vector<Isa> supportedIsas() {
  std::vector<Isa> all;
  for (const auto& [isa, name] : kIsas.entries) {
    if (isaSupported(isa)) all.push_back(isa);
  }
  return all;
}

Isa bestIsa() { return supportedIsas().back(); }

ThreadTeam::ThreadTeam(int size)
    : size_(std::max(size, 1)), signals_(static_cast<std::size_t>(size_)) {
  std::vector<int> usable = usableCores();
  if (std::cmp_less_equal(size, usable.size())) {
    spins_ = kSpins;
    shared_cores_ = std::move(usable);
  }
  threads_.reserve(static_cast<std::size_t>(size_ - 1));
  try {
    for (int worker = 1; worker < size; ++worker) {
      threads_.emplace_back([this, worker] { workerLoop(worker); });
    }
  } catch (const std::system_error&) {  // the system grants no more threads
    stop();
    throw;
  }
}

ThreadTeam::ThreadTeam(int size, ParallelFor parallel_for)
    : size_(std::max(size, 1)), parallel_for_(std::move(parallel_for)) {}

ThreadTeam::~ThreadTeam() { stop(); }

bool ThreadTeam::pin(std::span<const int> cores, std::span<const int> usable) {
  bool all = std::cmp_equal(cores.size(), size()) && bind(::pthread_self(), cores.first(1));
  for (std::size_t i = 0; all && i < threads_.size(); ++i) {
    all = bind(threads_[i].native_handle(), cores.subspan(i + 1, 1));
  }
  shared_cores_.clear();
  caller_core_ = -1;
  if (all) return true;
  bind(::pthread_self(), usable);
  for (std::thread& thread : threads_) bind(thread.native_handle(), usable);
  if (std::cmp_less_equal(size(), usable.size()))
    shared_cores_.assign(usable.begin(), usable.end());
  return false;
}

/// In virtual machines Linux often wakes a thread on the core of the waking thread although
/// another core is idle: then both share the core for a frame.
void ThreadTeam::avoidCallerCore() {
  const int core = ::sched_getcpu();
  if (shared_cores_.empty() || core == caller_core_) return;
  caller_core_ = core;
  for (std::thread& thread : threads_) bind(thread.native_handle(), shared_cores_, core);
}

void ThreadTeam::stop() {
  stopping_.store(true);
  announceJob(static_cast<int>(threads_.size()) + 1);
  for (std::thread& thread : threads_) thread.join();
}

void ThreadTeam::runJob(int worker) {
  try {
    job_.call(job_.context, worker);
  } catch (...) {
    if (!failed_.exchange(true)) failure_ = std::current_exception();
  }
}

void ThreadTeam::announceJob(int workers) {
  for (int worker = 1; worker < workers; ++worker) {
    std::atomic<unsigned>& generation = signals_[static_cast<std::size_t>(worker)].generation;
    generation.store((generation.load(std::memory_order_relaxed) | 1U) + 1,
                     std::memory_order_release);
    generation.notify_one();
  }
}

void ThreadTeam::wake(int workers) {
  if (threads_.empty() || spins_ == 0 || workers < 2) return;
  avoidCallerCore();
  for (int worker = 1; worker < workers; ++worker) {
    std::atomic<unsigned>& generation = signals_[static_cast<std::size_t>(worker)].generation;
    generation.store(generation.load(std::memory_order_relaxed) | 1U, std::memory_order_release);
    generation.notify_one();
  }
}

void ThreadTeam::start(int workers, Job job) {
  if (workers == 1) return job.call(job.context, 0);
  job_ = job;
  if (parallel_for_) {
    failed_ = false;  // in the last run a job may have thrown before parallel_for_ did
    parallel_for_(workers, [this](int worker) { runJob(worker); });
  } else {
    busy_.store(workers - 1, std::memory_order_relaxed);
    avoidCallerCore();
    announceJob(workers);
    runJob(0);
    const int spins = spins_ > 0 ? kHotSpinCount : 0;  // the wait is short, a wake-up long
    for (int busy = busy_; busy != 0;) busy = awaitChange(busy_, busy, spins);
  }
  if (failed_.exchange(false)) std::rethrow_exception(std::exchange(failure_, nullptr));
}

void ThreadTeam::workerLoop(int worker) {
  const std::atomic<unsigned>& generation = signals_[static_cast<std::size_t>(worker)].generation;
  for (unsigned seen = 0;;) {
    const bool is_awake = (seen & 1U) != 0;
    seen = awaitChange(generation, seen, is_awake ? kHotSpinCount : spins_);
    if (stopping_.load()) return;
    if ((seen & 1U) != 0) continue;
    runJob(worker);
    if (busy_.fetch_sub(1, std::memory_order_acq_rel) == 1) busy_.notify_one();
  }
}

}  // namespace broadmark
