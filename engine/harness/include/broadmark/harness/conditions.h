// Under which conditions a case was run: what times depend on beside machine, case and recording.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "broadmark/harness/case_run.h"

namespace broadmark {

struct Conditions {
  CheckMode check = CheckMode::full;
  int warmup = 0;       ///< unmeasured repetitions before
  int repetitions = 0;  ///< that were asked for; fewer were run when the run was interrupted
  // Limits in seconds; nothing: no limit.
  std::optional<double> frame_limit_seconds;
  std::optional<double> initialize_limit_seconds;
  std::optional<double> call_limit_seconds;  ///< on one call into the algorithm
  bool in_process = false;                   ///< not in a worker process of its own
  bool pinned = false;                       ///< each thread to a core of its own
  double load_average = 0;                   ///< over the last minute, when the case began
  PluginBuild plugin;                        ///< of an algorithm of a plug-in
  std::vector<std::string> warnings;         ///< what may have disturbed the times
};

}  // namespace broadmark
