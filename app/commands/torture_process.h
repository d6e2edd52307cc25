// A process in which many rounds of a torture run, one after the other, without the cost of a
// process per case and of a message per frame.
//
// It is another instance of the same command (--serve-rounds). It only tells that a round went
// wrong; which case did is found by running the round again, with each case in a worker process.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "broadmark/files.h"
#include "broadmark/fuzz/torture.h"
#include "broadmark/harness/child_process.h"
#include "support/line_channel.h"

namespace broadmark {

class TortureProcess {
 public:
  explicit TortureProcess(std::uint64_t seed) : seed_(seed) {}
  ~TortureProcess() { end(); }
  TortureProcess(const TortureProcess&) = delete;
  TortureProcess& operator=(const TortureProcess&) = delete;

  /// Runs a round; returns its coverage unless something went wrong, which may also be the effect
  /// of an earlier round.
  struct Outcome {
    TortureCoverage coverage;
    std::optional<SuspectedFault> suspected;
    std::vector<std::uint64_t> earlier;  ///< rounds that the process had run before
  };
  /// Throws Cancelled, and InputError if the process cannot be started.
  Outcome run(std::uint64_t number, const CancelQuery& cancelled);

 private:
  void start(const CancelQuery& cancelled);
  /// As LineChannel::read(); ends the process when cancelled.
  std::optional<std::string> readLine(const CancelQuery& cancelled);
  /// Kills the process, unless it has ended. Returns its wait status.
  int end();

  std::uint64_t seed_;
  ChildProcess process_;
  LineChannel lines_;
  std::vector<std::uint64_t> rounds_;  ///< that the process has run
};

/// The other side's end of the connection.
class TortureChannel {
 public:
  /// Runs rounds until the other side hangs up. A frame that takes longer than `limit` ends this
  /// process.
  void serve(TortureOptions options, std::chrono::duration<double> limit);

 private:
  FileDescriptor socket_ = serveParent();
};

}  // namespace broadmark
