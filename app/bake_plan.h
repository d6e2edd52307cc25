// What a batch of recordings comes to, found out before anything is simulated. Prints nothing:
// command line and windows alike plan with planBake(), then hand the jobs to a BakeBatch.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

#include "batch.h"
#include "scene_options.h"

namespace broadmark {

/// What is to be baked.
struct BakeOptions {
  std::vector<std::string> scenes;           ///< built-in ones, and files that describe one
  SceneOptions scene;
  ParameterValues parameters;                ///< --param
  std::filesystem::path output;
  int threads = 1;
  bool force = false;  ///< also what is already there
};

/// A batch before it begins.
struct BakePlan {
  std::vector<BakeJob> pending;  ///< only with the recordings that are to be written
  std::vector<std::filesystem::path> kept;

  /// Recordings to be written.
  [[nodiscard]] std::size_t recordings() const;
  /// What they take on the disc, without the .json beside each.
  [[nodiscard]] std::uint64_t bytes() const;
};

/// Told which recording that is there is checked next, the `number`-th of `total`; returning false
/// stops.
using PlanProgress =
    std::function<bool(const std::filesystem::path&, std::uint64_t number, std::uint64_t total)>;

/// Every combination of the options' scenes, object types and object counts once, without what is
/// already there. Reads those recordings through, unless the options say to bake them anew. Nothing
/// when stopped. Throws InputError.
std::optional<BakePlan> planBake(const BakeOptions&, const PlanProgress& = {});

/// Makes the directories. Fails now rather than after hours: throws InputError when the recordings
/// would not fit on the disc or one of them cannot be written.
void prepare(const BakePlan&, const std::filesystem::path& output);

}  // namespace broadmark
