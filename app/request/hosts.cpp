// Worker processes of this program: `broadmark worker`.

#include "request/hosts.h"

#include "broadmark/harness/memory_limit.h"
#include "broadmark/harness/worker_process.h"

namespace broadmark {

ExecutorFactory hostMaker(const HostOptions& options) {
  const bool other = !options.program.empty();
  if (options.in_process && !other) return makeLocalHost;
  constexpr double kGibibyte = 1 << 30;
  const auto& limit = options.memory_limit_gib;
  const WorkerOptions worker{
      // This very program, even if another has taken its name meanwhile.
      .command = {other ? std::filesystem::absolute(options.program).string() : "/proc/self/exe",
                  "worker"},
      .hard_limit = std::chrono::duration<double>(options.hard_limit_seconds),
      .memory_limit_bytes =
          limit ? static_cast<std::uint64_t>(*limit * kGibibyte) : machineMemory(),
      .pin = options.pin};
  return [worker](const Case& test_case, CancelQuery cancelled) {
    WorkerOptions own = worker;
    own.cancelled = std::move(cancelled);
    return makeWorkerProcess(test_case, std::move(own));
  };
}

}  // namespace broadmark
