// A case in a process of its own: whatever its algorithm does, everything else goes on, and the
// memory it takes is its own.
//
// The worker process is a program with a command that calls serveCase(): this one, or another
// build of it. Both sides talk by messages, one JSON object each; frames and answers lie in memory
// that both share. From there the worker copies a frame into memory of its own before the clock
// starts. What is said is told in engine/worker/protocol.h; it has a version.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "broadmark/harness/case_host.h"

namespace broadmark {

namespace worker {
class SharedMemory;
}

struct WorkerOptions {
  /// What to start: a program, and the arguments that make it call serveCase().
  std::vector<std::string> command;
  /// On a single call into the algorithm; then the process is killed.
  std::chrono::duration<double> hard_limit{60};
  /// On the process's first answers: to its start, and to the case that it is to run.
  std::chrono::duration<double> begin_limit{60};
  /// Data that the process may hold; beyond it, allocating fails. 0: whatever the system gives.
  std::uint64_t memory_limit_bytes = 0;
  bool pin = false;  ///< as LocalHost does
  CancelQuery cancelled = {};
};

/// The host of a case in a worker process, which lasts from the first start() until it fails or
/// this goes. The next start() after a failure has a new process.
class WorkerProcess final : public CaseHost {
 public:
  WorkerProcess(Case run, WorkerOptions options);
  ~WorkerProcess() override;
  WorkerProcess(const WorkerProcess&) = delete;
  WorkerProcess& operator=(const WorkerProcess&) = delete;

  /// Throws InputError when the process cannot be started or speaks another version.
  std::int64_t start(const SceneInfo& scene, const Frame& first) override;
  FrameRun step(const Frame& frame) override;
  void stop() override;
  PairDigest digest() override;
  PairRuns answer() override;
  PairEvents events() override;
  Counts counters() override;
  Counts setup() override;
  RecordedDrawing structure() override;
  std::string validate() override;

 private:
  class Link;  ///< to a process

  /// Starts the process, if there is none.
  void open();
  void shareChanged(const worker::SharedMemory& memory, const Frame& frame);
  /// Calls talk(link); drops the link when its process has ended.
  template <class Talk>
  auto talk(Talk&& talk);

  Case case_;
  WorkerOptions options_;
  std::unique_ptr<Link> link_;  ///< null: no process runs
  std::vector<Aabb> changed_boxes_;
  std::vector<Pair> answer_;  ///< of events: those that began
  std::vector<Pair> ended_;
  PairRun answer_run_;
  PairRun ended_run_;
};

/// Finds an algorithm by its id and the file of its plug-in ("": built in). Throws InputError.
using AlgorithmFinder = std::function<Algorithm(const std::string& id, const std::string& plugin)>;

/// The worker's side: serves the process that started this one until that hangs up. Throws
/// InputError when nobody did.
void serveCase(const AlgorithmFinder& find);

}  // namespace broadmark
