// Many simulations baked at the same time.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "broadmark/scenes/simulation.h"

namespace broadmark {

/// A simulation to be baked.
struct BakeJob {
  std::unique_ptr<Simulation> simulation;  ///< dropped once it is baked
  SceneInfo scene;
  std::vector<std::filesystem::path> paths;  ///< a recording each
};

/// A job that has ended.
struct BakedJob {
  std::vector<std::filesystem::path> paths;
  std::string failure;  ///< "": baked
};

/// The progress of a batch.
struct BatchState {
  std::uint64_t done = 0;   ///< body-frames
  std::uint64_t total = 0;  ///< likewise
  double seconds_left = 0;
  std::string running;  ///< the recordings being baked now, as text
};

/// Bakes simulations on its own threads. Each runs on one thread, so that a recording does not
/// depend on their number. The largest begin first, so that none of them is left for the end, and
/// only as many run at a time as fit into memory. One that fails does not stop the others. After an
/// interruption (InterruptGuard) unfinished ones leave nothing behind.
class BakeBatch {
 public:
  BakeBatch(std::vector<BakeJob> jobs, int threads);
  /// Stops what is running.
  ~BakeBatch();
  BakeBatch(const BakeBatch&) = delete;
  BakeBatch& operator=(const BakeBatch&) = delete;

  /// Waits up to `patience` for a job to end; returns at once when all have. Returns those that
  /// have ended since the last call, without interrupted ones.
  std::vector<BakedJob> await(std::chrono::milliseconds patience);
  /// Begins no more jobs and stops those that run, which leave nothing behind. Does not wait:
  /// see ended().
  void cancel();
  /// Whether all threads have ended.
  [[nodiscard]] bool ended();
  [[nodiscard]] BatchState state();

 private:
  using Clock = std::chrono::steady_clock;
  struct Run;

  void work();
  Run* take();
  void perform(Run&);
  [[nodiscard]] bool fits(const Run&) const;
  [[nodiscard]] bool stopped() const;

  std::vector<std::unique_ptr<Run>> runs_;  ///< largest first
  std::uint64_t memory_bytes_;
  std::atomic<bool> stopping_ = false;
  // Below: guarded by mutex_.
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<BakedJob> ended_;
  std::size_t active_threads_;
  std::exception_ptr broken_;  ///< an error that concerns the whole batch
  std::vector<std::thread> threads_;
};

}  // namespace broadmark
