// Warnings about what may disturb the times of a run, printed before measuring.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "broadmark/harness/case.h"
#include "broadmark/harness/environment.h"
#include "broadmark/harness/noise_warnings.h"

namespace broadmark {

/// Prints warnings on standard error, without duplicates and even with --quiet, as they cast doubt
/// on measured times.
class RunWarnings {
 public:
  /// Observes the machine's load for a moment, before our own work starts. `environment` must
  /// outlive this.
  explicit RunWarnings(const Environment& environment);

  /// Returns the warnings that concern a case, and prints those not printed yet.
  std::vector<std::string> warningsFor(const Case& test_case);

  /// Prints a warning.
  static void print(const std::string& warning);

 private:
  const Environment& environment_;
  MachineState machine_;
  std::set<std::string> shown_;
};

}  // namespace broadmark
