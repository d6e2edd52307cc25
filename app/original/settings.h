// Settings files and logs of the original Broadmark.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "broadmark/results/results.h"

namespace broadmark {

/// Settings with the original's keys and defaults; unknown keys are ignored, as in the original.
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

/// Whether a JSON text is a settings file. Throws InputError, calling the text `name`, if it is not
/// JSON.
bool isOriginalSettings(std::string_view json, std::string_view name);

/// Parses a settings file. Throws InputError that states `name`, the key and what is expected.
OriginalSettings parseOriginalSettings(std::string_view json, std::string_view name);

/// Formats a log like the original's: the settings with m_numberOfObjects, then seconds per phase
/// for each frame of the first repetition.
std::string formatOriginalLog(const OriginalSettings&, const CaseResult&);

}  // namespace broadmark
