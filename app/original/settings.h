// The settings files and logs of the original Broadmark.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "broadmark/results.h"

namespace broadmark {

/// A settings file with the original's keys and defaults; unknown keys are ignored as there.
struct OriginalSettings {
  std::string input_scene;
  std::string output_log;
  std::string algorithm;
  std::string pretty_name;
  std::array<double, 3> margin = {0.01, 0.01, 0.01};  ///< KD only
  std::int64_t threads = 4;
  std::int64_t grid_objects_per_cell = 200;
  std::int64_t tracy_objects_per_cell = 200;
  std::int64_t kd_objects_per_leaf = 512;
  std::int64_t gpu_sap_kernel_type = 5;
};

/// What kind of JSON a text is: "broadmark-results/1" and the like, "original-settings", or "",
/// whatever tells so first: what follows that is not read. Throws InputError if it is not JSON.
std::string jsonKind(std::string_view json, std::string_view name);

/// Throws InputError naming `name`, the key and what would be right.
OriginalSettings parseOriginalSettings(std::string_view json, std::string_view name);

/// The log in the original's structure: its settings with m_numberOfObjects, then seconds per phase
/// for each frame of the first repetition.
std::string formatOriginalLog(const OriginalSettings&, const CaseResult&);

}  // namespace broadmark
