// How a case is executed: which instruction set, how many threads, which compute device.
//
// Example:
//
//   ExecutionContext execution(4, bestIsa());  // the caller and three threads
//   std::vector<double> sums(static_cast<std::size_t>(execution.threads()));
//   execution.team().run(1'000'000, [&](int worker, Range items) {
//     sums[static_cast<std::size_t>(worker)] = static_cast<double>(items.end - items.begin);
//   });
#pragma once

#include <algorithm>
#include <atomic>
#include <concepts>
#include <exception>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <thread>
#include <type_traits>
#include <utility>
#include <vector>

#include "broadmark/names.h"
#include "broadmark/range.h"

namespace broadmark {

/// Instruction sets for which there are kernels. avx2 includes BMI and POPCNT; avx512 is F, BW, DQ,
/// VL and CD, with BMI2.
enum class Isa { scalar, sse2, neon, simd128, avx2, avx512 };
/// All instruction sets, narrowest first.
inline constexpr NameTable kIsas{{NamedValue{Isa::scalar, "scalar"},
                                  {Isa::sse2, "sse2"},
                                  {Isa::neon, "neon"},
                                  {Isa::simd128, "simd128"},
                                  {Isa::avx2, "avx2"},
                                  {Isa::avx512, "avx512"}}};
/// The name as in kIsas: "avx2".
constexpr std::string_view isaName(Isa isa) { return kIsas.nameOf(isa); }

/// Whether this processor (and system) supports the instruction set.
bool isaSupported(Isa);
/// The supported instruction sets, narrowest first. Never empty: scalar always is.
std::vector<Isa> supportedIsas();
/// The widest supported instruction set.
Isa bestIsa();

/// Runs jobs on threads of the caller: calls job(worker) once for each worker below `workers`, in
/// any order, at the same time or one after another, and returns when all calls have. The job does
/// not throw.
using ParallelFor = std::function<void(int workers, const std::function<void(int worker)>& job)>;

/// How many of up to `max_workers` pay for work that one of them does in about `work_ns`: those
/// with a share of at least `min_share_ns` each. A share must outweigh waking a sleeping thread,
/// which takes up to 0.1 ms in a virtual machine. At least 1. An estimate instead of a clock: equal
/// frames are divided alike.
inline constexpr double kMinShareNs = 150'000;
inline int workersThatPay(double work_ns, int max_workers, double min_share_ns = kMinShareNs) {
  if (work_ns >= min_share_ns * max_workers) return max_workers;
  return std::max(1, static_cast<int>(work_ns / min_share_ns));
}

/// Exactly `size` workers, the caller being worker 0. A benchmark needs a fixed number of threads
/// with fixed shares (same answer for the same count, no stealing, no allocation per call); that,
/// and a clean ThreadSanitizer, is why this is not a task scheduler. Given enough cores, no worker
/// runs on the caller's.
///
/// Called by one thread at a time, which is worker 0. Its own threads spin for some 20 µs after a
/// job before they sleep, unless there are fewer usable cores than workers.
class ThreadTeam {
 public:
  /// Starts size - 1 threads; a size below 1 counts as 1. Throws std::system_error if the system
  /// grants too few.
  explicit ThreadTeam(int size);
  /// Workers without threads of their own: each job for several workers is a call of
  /// `parallel_for`, whose exceptions pass through.
  ThreadTeam(int size, ParallelFor parallel_for);
  /// Waits for the threads to end.
  ~ThreadTeam();
  ThreadTeam(const ThreadTeam&) = delete;
  ThreadTeam& operator=(const ThreadTeam&) = delete;

  [[nodiscard]] int size() const { return size_; }

  /// Binds worker i, the caller being worker 0, to the core `cores[i]`: system numbers, as those of
  /// usableCores(). Returns whether the system allowed all bindings; if not, or if there are not as
  /// many cores as workers, all workers may use the cores `usable`. The caller's binding outlasts
  /// the team.
  bool pin(std::span<const int> cores, std::span<const int> usable);

  /// Wakes the first `workers` ahead of work expected within half a millisecond, for which they
  /// spin. A wake-up takes a tenth of that, and far more in a virtual machine. Does not wait; does
  /// nothing if workers outnumber the usable cores, or run by a ParallelFor.
  void wake(int workers);
  void wake() { wake(size()); }

  /// Calls work(worker) once for each of the first `workers`, 1 to size(), in parallel, and returns
  /// when all are done. The others sleep on. The first exception of any worker is rethrown here,
  /// when all are done. Not reentrant. Allocates nothing. With one worker, a plain call.
  template <class Work>
  void runOn(int workers, Work&& work) {
    using Plain = std::remove_reference_t<Work>;
    start(workers, {[](void* context, int worker) { (*static_cast<Plain*>(context))(worker); },
                    const_cast<void*>(static_cast<const void*>(std::addressof(work)))});
  }
  /// The same for all workers.
  template <class Work>
  void run(Work&& work) {
    runOn(size(), work);
  }

  /// Calls work(worker, range) for each worker, with its share of `count` items, which may be
  /// empty.
  template <class Work>
  void run(std::size_t count, Work&& work) {
    run([&](int worker) { work(worker, share(count, size(), worker)); });
  }

 private:
  struct Job {
    void (*call)(void* context, int worker) = nullptr;
    void* context = nullptr;
  };
  /// On a cache line of its own, as its worker spins on it.
  struct alignas(64) Signal {
    /// Twice the number of jobs so far; plus one after wake().
    std::atomic<unsigned> generation{0};
  };
  void start(int workers, Job);
  void avoidCallerCore();
  void announceJob(int workers);
  void runJob(int worker);
  void workerLoop(int worker);
  void stop();

  int size_;
  ParallelFor parallel_for_;  ///< null: own threads
  int spins_ = 0;             ///< spins of a waiting worker before it sleeps
  Job job_;
  std::vector<Signal> signals_;  ///< by worker
  std::atomic<int> busy_{0};
  std::atomic<bool> stopping_{false};
  std::atomic<bool> failed_{false};
  std::exception_ptr failure_;
  std::vector<std::thread> threads_;
  std::vector<int>
      shared_cores_;      ///< for all workers; empty if there are too few, or workers are pinned
  int caller_core_ = -1;  ///< avoided by the other workers
};

/// A costly resource shared by all instances of an ExecutionContext, such as a device's context. A
/// derived class has a constructor with an ExecutionContext& as its argument.
class SharedResource {
 public:
  virtual ~SharedResource() = default;
};

/// The resources that the runner gives to an algorithm. Outlives the algorithm's instance. Used by
/// one thread at a time, except for its team's workers.
class ExecutionContext {
 public:
  /// Starts threads - 1 threads: throws std::system_error if the system grants too few. `isa` must
  /// be supported if the algorithm has kernels.
  ExecutionContext(int threads, Isa isa, std::string device = {})
      : isa_(isa), device_(std::move(device)), team_(threads) {}
  /// On threads of the caller, by this function.
  ExecutionContext(int threads, Isa isa, ParallelFor parallel_for)
      : isa_(isa), team_(threads, std::move(parallel_for)) {}
  /// Destroys the latest resource first: it may depend on earlier ones.
  ~ExecutionContext() {
    while (!resources_.empty()) resources_.pop_back();
  }
  ExecutionContext(const ExecutionContext&) = delete;
  ExecutionContext& operator=(const ExecutionContext&) = delete;

  /// The instruction set for which to choose kernels.
  [[nodiscard]] Isa isa() const { return isa_; }
  /// The number of workers, the caller's thread included.
  [[nodiscard]] int threads() const { return team_.size(); }
  ThreadTeam& team() { return team_; }
  /// The requested compute device: its number, or a part of its name; "": the first.
  [[nodiscard]] const std::string& device() const { return device_; }

  /// The resource of that type, created at first use, which may throw what its constructor throws.
  /// Valid as long as this context.
  template <std::derived_from<SharedResource> Resource>
  Resource& shared() {
    for (const auto& resource : resources_) {
      if (auto* found = dynamic_cast<Resource*>(resource.get())) return *found;
    }
    return static_cast<Resource&>(*resources_.emplace_back(std::make_unique<Resource>(*this)));
  }

 private:
  Isa isa_;
  std::string device_;
  std::vector<std::unique_ptr<SharedResource>> resources_;
  ThreadTeam team_;
};

}  // namespace broadmark
