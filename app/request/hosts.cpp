// Worker processes of this program: `broadmark worker`.

#include "request/hosts.h"

#include <memory>

#include "broadmark/harness/memory_limit.h"
#include "broadmark/harness/worker_process.h"

namespace broadmark {
namespace {

namespace fs = std::filesystem;

std::uint64_t memoryLimit(const HostOptions& options) {
  constexpr double kGibibyte = 1 << 30;
  if (options.memory_limit_gib) {
    return static_cast<std::uint64_t>(*options.memory_limit_gib * kGibibyte);
  }
  return machineMemory();
}

}  // namespace

HostMaker hostMaker(const HostOptions& options) {
  const bool other = !options.program.empty();
  if (options.in_process && !other) return makeLocalHost;
  const WorkerOptions worker{
      // This very program, even if another has taken its name meanwhile.
      .command = {other ? fs::absolute(options.program).string() : "/proc/self/exe", "worker"},
      .hard_limit = std::chrono::duration<double>(options.hard_limit_seconds),
      .memory_limit_bytes = memoryLimit(options),
      .pin = options.pin};
  return [worker](const Case& run, CancelQuery cancelled) {
    WorkerOptions own = worker;
    own.cancelled = std::move(cancelled);
    return makeWorkerProcess(run, std::move(own));
  };
}

}  // namespace broadmark
