// Any messages as what a worker process says, a line each, and behind a zero byte any bytes as the
// memory that it shares: each call returns what can be used, or throws.

#include <fmt/format.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <exception>
#include <vector>

#include "broadmark/algorithms.h"
#include "broadmark/error.h"
#include "broadmark/harness/case.h"
#include "broadmark/harness/worker_process.h"
#include "fuzzed_file.h"

namespace broadmark {
namespace {

/// All calls of a case, until the process is lost.
void callEverything(CaseExecutor& host) {
  const std::vector<Aabb> boxes(2, Aabb{{0, 0, 0, 0}, {1, 1, 1, 0}});
  const SceneInfo scene{.name = "fuzz", .object_type = "Cubes", .objects = 2, .frames = 1};
  const std::vector<std::uint32_t> nobody;
  std::size_t seen = 0;
  bool is_lost = false;
  const auto attempt = [&](auto&& call) {
    if (is_lost) return;
    try {
      call();
    } catch (const HostError&) {
      is_lost = true;
    } catch (const HardLimitError&) {
      is_lost = true;
    } catch (const std::exception&) {  // told as the reason why the case failed
    }
  };
  const auto look = [&](PairRuns runs) {
    for (const PairRun part : runs) {
      for (const Pair pair : part) seen += pair.a + pair.b;
    }
  };
  bool started = false;
  attempt([&] {
    host.start(scene, {0, boxes, nobody});
    started = true;
  });
  if (!started) return;
  attempt([&] { host.step({1, boxes, nobody}); });
  attempt([&] { host.digest(); });
  attempt([&] { look(host.answer()); });
  attempt([&] {
    const PairEvents events = host.events();
    look(events.began);
    look(events.ended);
  });
  attempt([&] { host.counters(); });
  attempt([&] { seen += host.structure().lines().size(); });
  attempt([&] { seen += host.validate().size(); });
  attempt([&] { host.stop(); });
}

}  // namespace
}  // namespace broadmark

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace broadmark;
  const FileDescriptor file = fuzz::fuzzedFile(data, size);
  WorkerOptions options;
  options.command = {WORKER_PARROT, fmt::format("/proc/{}/fd/{}", ::getpid(), file.get())};
  options.hard_limit = options.begin_limit = std::chrono::seconds(5);
  static const Case test_case = makeCase(builtinAlgorithms().front(), Isa::scalar, 1, "", {});
  callEverything(*makeWorkerProcess(test_case, options));
  return 0;
}
