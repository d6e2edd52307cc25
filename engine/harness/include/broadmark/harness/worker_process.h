// A case in a process of its own: whatever its algorithm does, everything else goes on, and the
// memory it takes is its own.
//
// The worker process is a program with a command that calls serveCase(): this one, or another
// build of it. Both sides talk by messages, one JSON object each; frames and answers lie in memory
// that both share. From there the worker copies a frame into memory of its own before the clock
// starts. What is said is told in worker/protocol.h; it has a version.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "broadmark/harness/case_executor.h"

namespace broadmark {

struct WorkerOptions {
  /// What to start: a program, and the arguments that make it call serveCase().
  std::vector<std::string> command;
  /// On a single call into the algorithm; then the process is killed.
  std::chrono::duration<double> hard_limit{60};
  /// On the process's first answers: to its start, and to the case that it is to run.
  std::chrono::duration<double> begin_limit{60};
  /// Data that the process may hold; beyond it, allocating fails. 0: whatever the system gives.
  std::uint64_t memory_limit_bytes = 0;
  bool pin = false;  ///< as InProcessExecutor does
  CancelQuery cancelled = {};
};

/// The host of a case in a worker process, which lasts from the first start() until it fails or the
/// host goes. The next start() after a failure has a new process; it throws InputError when the
/// process cannot be started or speaks another version.
std::unique_ptr<CaseExecutor> makeWorkerProcess(Case run, WorkerOptions options);

/// Finds an algorithm by its id and the file of its plug-in ("": built in). Throws InputError.
using AlgorithmFinder = std::function<Algorithm(const std::string& id, const std::string& plugin)>;

/// The worker's side: serves the process that started this one until that hangs up. Throws
/// InputError when nobody did.
void serveCase(const AlgorithmFinder& find);

}  // namespace broadmark
