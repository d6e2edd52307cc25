// Conditions of a case's run that affect its times, besides machine, case and recording.
//
// Example:
//
//   const auto equallyLong = [](const Conditions& a, const Conditions& b) {
//     return a.warmup == b.warmup && a.repetitions == b.repetitions;
//   };
//   const bool comparable = equallyLong({.warmup = 1, .repetitions = 5}, Conditions());
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "broadmark/harness/case_run.h"

namespace broadmark {

/// A record for results: it changes nothing. The command line fills it in; runRepetition() sets
/// only `counted_by` and `pinned`.
struct Conditions {
  CheckMode check = CheckMode::full;
  int warmup = 0;       ///< unmeasured passes at the start of each repetition
  int repetitions = 0;  ///< requested; an interrupted run has fewer
  // Limits in seconds; nullopt: no limit.
  std::optional<double> frame_limit_seconds;
  std::optional<double> initialize_limit_seconds;
  std::optional<double> call_limit_seconds;  ///< on one call, by killing the worker process
  /// What counted instructions, instead of times; nullopt: times were measured.
  std::optional<CounterSource> counted_by;
  bool in_process = false;  ///< without a worker process of its own
  bool pinned = false;      ///< each thread to its own core
  /// Of the machine, over the minute before the recording's first case.
  double load_average = 0;
  PluginBuild plugin;                 ///< of the algorithm's plug-in
  std::vector<std::string> warnings;  ///< possible disturbances of the times
};

}  // namespace broadmark
