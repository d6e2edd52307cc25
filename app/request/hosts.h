// Where cases run: in worker processes, which are instances of this program, or in this process.
#pragma once

#include <filesystem>
#include <optional>

#include "broadmark/harness/case_executor.h"

namespace broadmark {

/// Whether this system can start processes: browsers cannot.
#if defined(__EMSCRIPTEN__)
inline constexpr bool kHasProcesses = false;
#else
inline constexpr bool kHasProcesses = true;
#endif

struct HostOptions {
  bool in_process = !kHasProcesses;
  std::filesystem::path program;  ///< build of this program that workers execute; "": this one
  double hard_limit_seconds = 60;
  bool valgrind = false;                   ///< workers run under valgrind: see prepareCount()
  bool pin = false;                        ///< bind each thread of a worker to its own core
  std::optional<double> memory_limit_gib;  ///< nothing: the machine's memory
};

/// The limit of a worker process.
std::uint64_t memoryLimitBytes(const HostOptions&);

ExecutorFactory executorFactory(const HostOptions&);

}  // namespace broadmark
