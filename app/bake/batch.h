// Many simulations baked at the same time.
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

/// A simulation to be baked.
struct BakeJob {
  std::unique_ptr<Simulation> simulation;  ///< dropped once it is baked
  SceneInfo scene;
  std::vector<std::filesystem::path> paths;  ///< a recording each

  [[nodiscard]] std::uint64_t bodies() const { return std::max(scene.objects, 1U); }
  /// In body-frames.
  [[nodiscard]] std::uint64_t work() const { return bodies() * scene.frames; }
};

/// A job that has ended.
struct BakedJob {
  std::vector<std::filesystem::path> paths;
  std::string failure;  ///< "": baked
};

/// The progress of a batch.
struct BatchState {
  std::uint64_t done = 0;   ///< body-frames
  std::uint64_t total = 0;  ///< bodies x frames of the whole batch
  double seconds_left = 0;
  std::string running;  ///< the recordings being baked now, as text
};

/// Bakes simulations, each on one thread, so that a recording does not depend on their number. The
/// largest begin first, so that none of them is left for the end, and only as many run at a time as
/// fit into memory. Meanwhile the calling thread calls `ended` for each job that has ended, and
/// `progress` now and then and at the end. A job that fails does not stop the others. After an
/// interruption (InterruptGuard), and once `progress` has returned false, unfinished ones leave
/// nothing behind, and `ended` is not called for them.
void bakeAll(std::vector<BakeJob> jobs, int threads,
             const std::function<void(const BakedJob&)>& ended,
             const std::function<bool(const BatchState&)>& progress);

}  // namespace broadmark
