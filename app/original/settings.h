// The settings files and logs of the original Broadmark.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "broadmark/results/results.h"

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

/// Whether a JSON text is such a file. Throws InputError if it is not JSON; `name` stands for it in
/// messages.
bool isOriginalSettings(std::string_view json, std::string_view name);

/// Throws InputError naming `name`, the key and what would be right.
OriginalSettings parseOriginalSettings(std::string_view json, std::string_view name);

/// The log in the original's structure: its settings with m_numberOfObjects, then seconds per phase
/// for each frame of the first repetition.
std::string formatOriginalLog(const OriginalSettings&, const CaseResult&);

}  // namespace broadmark
