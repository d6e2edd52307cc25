// Worker processes of this program: `broadmark worker`.

#include "request/hosts.h"

#include "broadmark/error.h"
#include "broadmark/harness/memory_limit.h"
#include "broadmark/harness/worker_process.h"
#include "support/child_program.h"

namespace broadmark {

std::uint64_t memoryLimitBytes(const HostOptions& options) {
  constexpr double kGibibyte = 1 << 30;
  if (!options.memory_limit_gib) return machineMemory();
  return static_cast<std::uint64_t>(*options.memory_limit_gib * kGibibyte);
}

ExecutorFactory executorFactory(const HostOptions& options) {
  const bool is_other_program = !options.program.empty();
  if (options.in_process && !is_other_program) return makeInProcessExecutor;
  if (options.valgrind && !isProgramInPath("valgrind")) {
    throw InputError(
        "--count: this system does not allow the processor's counters, and there is "
        "no valgrind: install it (Debian's package valgrind)");
  }
  const WorkerOptions defaults{
      // This program, even if its file has been replaced meanwhile.
      .command = {is_other_program ? std::filesystem::absolute(options.program).string()
                                   : "/proc/self/exe",
                  "worker"},
      .hard_limit = std::chrono::duration<double>(options.hard_limit_seconds),
      // valgrind reads the program's symbols first.
      .begin_limit = std::chrono::seconds(options.valgrind ? 600 : 60),
      .memory_limit_bytes = memoryLimitBytes(options),
      .pin = options.pin,
      .valgrind = options.valgrind};
  return [defaults](const Case& test_case, CancelQuery cancelled) {
    WorkerOptions worker = defaults;
    worker.cancelled = std::move(cancelled);
    return makeWorkerProcess(test_case, std::move(worker));
  };
}

}  // namespace broadmark
