// Which recordings a batch is to bake, found out before anything is simulated. Prints nothing:
// command line and inspector alike plan with planBake(), then hand the jobs to bakeAll().
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

#include "bake/batch.h"
#include "request/run_request.h"

namespace broadmark {

/// What is to be baked: the recordings of the request's scenes (built-in ones, and files that
/// describe a scene; none: all), into its directory.
struct BakeOptions : RunRequest {
  int threads = 1;
  bool force = false;  ///< also what is already there
};

/// The size of a recording that is to be written: exact, but for .broadmark, which will be larger.
std::uint64_t leastBytes(const std::filesystem::path& path, SceneInfo scene);

/// A batch before it begins.
struct BakePlan {
  std::vector<BakeJob> pending;  ///< only with the recordings that are to be written
  std::vector<std::filesystem::path> kept;

  /// How many recordings are to be written.
  [[nodiscard]] std::size_t recordings() const;
  /// Their leastBytes() on the disc, without the sidecars.
  [[nodiscard]] std::uint64_t bytes() const;
};

/// Told before an existing recording is checked, the `number`-th of `total`; returning false stops.
using PlanProgress =
    std::function<bool(const std::filesystem::path&, std::uint64_t number, std::uint64_t total)>;

/// Every combination of the options' scenes and parameter values once. What is already
/// there is kept; to know that, those recordings are read through, unless `force`. Nothing when
/// stopped. Throws InputError.
std::optional<BakePlan> planBake(const BakeOptions&, const PlanProgress& = {});

/// Makes the directories. Throws InputError when the recordings would not fit on the disc or one of
/// them cannot be written: to fail now rather than after hours.
void prepare(const BakePlan&, const std::filesystem::path& output);

}  // namespace broadmark
