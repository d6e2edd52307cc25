// Determines which recordings a batch has to bake, before any simulation. Prints nothing: both
// command line and inspector call planBake(), then pass the jobs to bakeAll().
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

#include "bake/batch.h"
#include "request/run_request.h"

namespace broadmark {

/// Options of a batch: bakes the request's scenes (built-in ones, and files that describe a scene;
/// none: all) into its directory.
struct BakeOptions : RunRequest {
  int threads = 1;
  bool force = false;  ///< bake existing recordings again
};

/// Size of a recording before it is written: exact, except for .broadmark, which will be larger.
std::uint64_t minBytes(const std::filesystem::path& path, SceneInfo scene);

/// A batch before it starts.
struct BakePlan {
  std::vector<BakeJob> pending;  ///< only with the recordings to write
  std::vector<std::filesystem::path> kept;

  /// Number of recordings to write.
  [[nodiscard]] std::size_t recordings() const;
  /// Their total minBytes(), without sidecars.
  [[nodiscard]] std::uint64_t bytes() const;
};

/// Called before and while existing recording `number` of `total` is checked; returning false
/// stops.
using PlanProgress =
    std::function<bool(const std::filesystem::path&, std::uint64_t number, std::uint64_t total)>;

/// Plans every combination of the options' scenes and parameter values, without duplicates. Unless
/// `force`, existing recordings are kept, after they have been read to verify them. Returns nothing
/// if stopped. Throws InputError.
std::optional<BakePlan> planBake(const BakeOptions&, const PlanProgress& = {});

/// Creates the directories. Throws InputError if the recordings do not fit on the disc or cannot be
/// written, to fail before hours of work.
void prepare(const BakePlan&, const std::filesystem::path& output);

}  // namespace broadmark
