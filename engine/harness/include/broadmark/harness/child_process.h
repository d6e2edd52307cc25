// Processes that this one starts.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <string>
#include <utility>
#include <vector>

#include "broadmark/harness/case_executor.h"

namespace broadmark {

/// How a process ended, from its status as of waitpid(): "crashed with SIGSEGV (Segmentation
/// fault)".
std::string endText(int wait_status);

class ChildProcess {
 public:
  struct Options {
    /// Become its descriptors 0, 1, 2, …; it inherits no others. -1: /dev/null, for reading.
    std::vector<int> descriptors;
    /// Added to our environment, or in place of a variable of ours.
    std::vector<std::pair<std::string, std::string>> variables = {};
    /// In a process group of its own: Ctrl-C does not reach it, and kill() also ends processes that
    /// it started.
    bool own_group = false;
  };

  ChildProcess() = default;
  /// Starts a program, searched for in PATH. Throws InputError if it cannot be started.
  ChildProcess(std::vector<std::string> command, const Options&);
  /// Kills it.
  ~ChildProcess();
  ChildProcess(ChildProcess&& other) noexcept
      : pid_(std::exchange(other.pid_, 0)), own_group_(other.own_group_) {}
  ChildProcess& operator=(ChildProcess&& other) noexcept {
    std::swap(pid_, other.pid_);
    std::swap(own_group_, other.own_group_);
    return *this;
  }

  /// Whether it was started, and neither kill() nor wait() has returned.
  [[nodiscard]] bool alive() const { return pid_ != 0; }
  /// Waits until it ends; after `grace`, or when cancelled, kills it. Returns its status, as
  /// waitpid().
  int wait(std::chrono::milliseconds grace, const CancelQuery& cancelled = {});
  /// Returns its status.
  int kill() { return wait({}); }

 private:
  pid_t pid_ = 0;
  bool own_group_ = false;
};

}  // namespace broadmark
