// A process that this one starts, and that does not outlive it.
#pragma once

#include <sys/types.h>

#include <initializer_list>
#include <string>
#include <vector>

namespace broadmark::worker {

class ChildProcess {
 public:
  /// Starts the command with these descriptors as 3, 4, … and no others: standard input is empty,
  /// what it prints goes to our standard error. Throws InputError when it cannot be started.
  ChildProcess(std::vector<std::string> command, std::initializer_list<int> handed);
  /// Kills it.
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// Whether kill() or wait() has seen its end.
  [[nodiscard]] bool ended() const { return pid_ == 0; }
  void kill();
  /// Waits for its end, and brings that about after a while. Says how it ended: "crashed with
  /// SIGSEGV (Segmentation fault)".
  std::string wait();

 private:
  pid_t pid_;
};

}  // namespace broadmark::worker
