// Bakes many simulations concurrently.
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "broadmark/scenes/simulation.h"

namespace broadmark {

/// A simulation to bake.
struct BakeJob {
  std::unique_ptr<Simulation> simulation;  ///< destroyed once baked
  SceneInfo scene;
  std::vector<std::filesystem::path> paths;  ///< one recording each

  [[nodiscard]] std::uint64_t bodies() const { return std::max(scene.objects, 1U); }
  /// Work in body-frames.
  [[nodiscard]] std::uint64_t work() const { return bodies() * scene.frames; }
};

/// A finished job.
struct BakedJob {
  std::vector<std::filesystem::path> paths;
  std::string failure;                    ///< error message; "": success
  std::vector<std::string> escapes = {};  ///< escapeTexts()
};

/// The progress of a batch.
struct BatchState {
  std::uint64_t done = 0;   ///< body-frames
  std::uint64_t total = 0;  ///< body-frames of the whole batch
  double seconds_left = 0;
  std::string running;  ///< description of the running jobs
};

/// Bakes simulations, each on a single thread, so that recordings do not depend on the number of
/// threads. The largest start first, and only as many run at a time as fit into memory. Meanwhile
/// the calling thread calls `on_finished` for each finished job, and `progress` regularly and at
/// the end. A failing job does not stop the others. After an interruption (InterruptGuard), or once
/// `progress` has returned false, unfinished jobs leave no files, and `on_finished` is not called
/// for them.
void bakeAll(std::vector<BakeJob> jobs, int threads,
             const std::function<void(const BakedJob&)>& on_finished,
             const std::function<bool(const BatchState&)>& progress);

}  // namespace broadmark
