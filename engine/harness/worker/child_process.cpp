#include "worker/child_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstring>
#include <thread>

#include "broadmark/error.h"
#include "broadmark/files.h"

namespace broadmark::worker {
namespace {

/// How long it may take to end by itself.
constexpr std::chrono::seconds kTimeToEnd{5};

std::string endText(int wait_status) {
  if (WIFEXITED(wait_status)) {
    return fmt::format("ended its process by itself, with status {}", WEXITSTATUS(wait_status));
  }
  const int signal = WTERMSIG(wait_status);
  const char* name = ::sigabbrev_np(signal);
  const std::string what =
      fmt::format("SIG{} ({})", name == nullptr ? "?" : name, ::sigdescr_np(signal));
  if (signal == SIGKILL) return "killed with " + what + ", perhaps as memory ran out";
  return "crashed with " + what;
}

/// What a new process does with its descriptors.
class DescriptorPlan {
 public:
  explicit DescriptorPlan(std::initializer_list<int> handed) {
    ::posix_spawn_file_actions_init(&actions_);
    ::posix_spawn_file_actions_addopen(&actions_, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    // What a plug-in prints is not to stand among our results.
    ::posix_spawn_file_actions_adddup2(&actions_, STDERR_FILENO, STDOUT_FILENO);
    int next = STDERR_FILENO + 1;
    for (const int descriptor : handed) hand(descriptor, next++);
    ::posix_spawn_file_actions_addclosefrom_np(&actions_, next);
  }
  ~DescriptorPlan() { ::posix_spawn_file_actions_destroy(&actions_); }
  DescriptorPlan(const DescriptorPlan&) = delete;
  DescriptorPlan& operator=(const DescriptorPlan&) = delete;

  [[nodiscard]] const posix_spawn_file_actions_t* get() const { return &actions_; }

 private:
  void hand(int from, int to) {
    // By way of a number beyond all of `to`, so that none is overwritten before its turn.
    constexpr int kBeyond = 16;
    copies_.emplace_back(::fcntl(from, F_DUPFD_CLOEXEC, kBeyond));
    ::posix_spawn_file_actions_adddup2(&actions_, copies_.back().get(), to);
  }

  posix_spawn_file_actions_t actions_{};
  std::vector<FileDescriptor> copies_;
};

pid_t spawn(std::vector<std::string> command, std::initializer_list<int> handed) {
  std::vector<char*> arguments;
  for (std::string& word : command) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const DescriptorPlan plan(handed);
  pid_t pid = 0;
  const int error =
      ::posix_spawn(&pid, arguments.front(), plan.get(), nullptr, arguments.data(), environ);
  if (error != 0) {
    throw InputError(fmt::format("{}: cannot be started as a worker process: {}", command.front(),
                                 std::strerror(error)));
  }
  return pid;
}

}  // namespace

ChildProcess::ChildProcess(std::vector<std::string> command, std::initializer_list<int> handed)
    : pid_(spawn(std::move(command), handed)) {}

ChildProcess::~ChildProcess() {
  if (!ended()) kill();
}

void ChildProcess::kill() {
  ::kill(pid_, SIGKILL);
  wait();
}

std::string ChildProcess::wait() {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + kTimeToEnd;
  int status = 0;
  while (::waitpid(pid_, &status, WNOHANG) == 0) {
    if (Clock::now() > end) ::kill(pid_, SIGKILL);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  pid_ = 0;
  return endText(status);
}

}  // namespace broadmark::worker
