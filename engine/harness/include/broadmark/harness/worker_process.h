// A case in its own process, which isolates other cases from crashes and measures its memory
// separately.
//
// The worker process is a program with a command that calls serveCase(): this program, or another
// build of it. The processes exchange messages, each a JSON object; frames and answers are in
// shared memory. The worker copies a frame to private memory before the clock starts.
// worker/protocol.h defines the versioned protocol.
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
  /// The command to start: a program, and the arguments with which it calls serveCase().
  std::vector<std::string> command;
  /// Limit on a single call of the algorithm; beyond it the process is killed.
  std::chrono::duration<double> hard_limit{60};
  /// Limit on the first two answers of a process: its version, and the answer to its case.
  std::chrono::duration<double> begin_limit{60};
  /// Limit on the process's data memory; beyond it, allocations fail. 0: no limit.
  std::uint64_t memory_limit_bytes = 0;
  bool pin = false;  ///< as in InProcessExecutor
  /// Runs the process under valgrind, to count instructions: its times are then meaningless, and
  /// its peak memory unknown.
  bool valgrind = false;
  CancelQuery cancelled = {};
};

/// Executes a case in a worker process, from the first start() until a failure or the executor's
/// destruction. The next start() after a failure has a new process; it throws InputError if the
/// process cannot be started or has another protocol version.
std::unique_ptr<CaseExecutor> makeWorkerProcess(Case test_case, WorkerOptions options);

/// Finds an algorithm by its id and its plug-in file ("": built in). Throws InputError.
using AlgorithmFinder = std::function<Algorithm(const std::string& id, const std::string& plugin)>;

/// The worker's side: serves the parent process until it hangs up. Throws InputError if this
/// process was not started as a worker.
void serveCase(const AlgorithmFinder& find);

}  // namespace broadmark
