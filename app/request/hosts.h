// Where the cases of a run live: in worker processes, which are this program again, or in this one.
#pragma once

#include <filesystem>
#include <optional>

#include "broadmark/harness/case_executor.h"

namespace broadmark {

struct HostOptions {
  bool in_process = false;
  std::filesystem::path program;  ///< another build of this program, for the workers; "": this one
  double hard_limit_seconds = 60;
  bool pin = false;                        ///< each thread to a core of its own; of workers only
  std::optional<double> memory_limit_gib;  ///< nothing: as much as the machine has
};

ExecutorFactory hostMaker(const HostOptions&);

}  // namespace broadmark
