// What may disturb the times of a run, said before they are measured.
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
  /// Watches the machine for a moment, as others use it: before our own work begins. `environment`
  /// outlives this.
  explicit RunWarnings(const Environment& environment);

  /// Those that concern a case. The ones that have not been said are said now.
  std::vector<std::string> of(const Case& test_case);

 private:
  const Environment& environment_;
  MachineState machine_;
  std::set<std::string> said_;
};

}  // namespace broadmark
