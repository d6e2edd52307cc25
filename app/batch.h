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

/// What has become of a job.
struct BakedJob {
  std::vector<std::filesystem::path> paths;
  std::string failure;  ///< "": they are baked
};

/// How far a batch is.
struct BatchState {
  std::uint64_t done = 0;   ///< body-frames
  std::uint64_t total = 0;  ///< likewise
  double seconds_left = 0;
  std::string running;  ///< what is being baked now, in words
};

/// Bakes simulations on threads of its own, each on one of them, so that a recording does
/// not depend on their number. The largest come first, lest one of them is left over when all else
/// is done; and only as many at a time as fit into memory. One that fails stops no other. After an
/// interruption (InterruptGuard) those that are not whole leave nothing behind.
class BakeBatch {
 public:
  BakeBatch(std::vector<BakeJob> jobs, int threads);
  /// Stops what still runs.
  ~BakeBatch();
  BakeBatch(const BakeBatch&) = delete;
  BakeBatch& operator=(const BakeBatch&) = delete;

  /// Waits up to `patience` for a recording to end, and for nothing once all have. Returns those
  /// that have ended since the last call; interrupted ones are never among them.
  std::vector<BakedJob> await(std::chrono::milliseconds patience);
  /// Begins no more recordings and stops those that run, which leave nothing behind. Does not wait:
  /// ended() tells when all is still.
  void cancel();
  /// Whether every thread has come to its end.
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
  std::exception_ptr broken_;  ///< an error that is no matter of one recording
  std::vector<std::thread> threads_;
};

}  // namespace broadmark
