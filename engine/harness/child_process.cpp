#include "broadmark/harness/child_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstring>

#include "broadmark/error.h"
#include "broadmark/files.h"

namespace broadmark {
namespace {

using Clock = std::chrono::steady_clock;

/// Interval for polling `cancelled` during a wait.
constexpr int kWaitMilliseconds = 10;

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  for (std::string& text : texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

std::vector<std::string> environmentWith(
    const std::vector<std::pair<std::string, std::string>>& variables) {
  std::vector<std::string> all;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string text = *entry;
    const std::string name = text.substr(0, text.find('='));
    const bool is_set = std::ranges::any_of(
        variables, [&](const auto& variable) { return variable.first == name; });
    if (!is_set) all.push_back(text);
  }
  for (const auto& [name, value] : variables) all.push_back(fmt::format("{}={}", name, value));
  return all;
}

}  // namespace

std::string endText(int wait_status) {
  if (WIFEXITED(wait_status)) {
    return fmt::format("exited with status {}", WEXITSTATUS(wait_status));
  }
  const int signal = WTERMSIG(wait_status);
  const char* name = ::sigabbrev_np(signal);
  const std::string what =
      fmt::format("SIG{} ({})", name == nullptr ? "?" : name, ::sigdescr_np(signal));
  if (signal == SIGKILL) return "killed with " + what + ", possibly out of memory";
  return "crashed with " + what;
}

ChildProcess::ChildProcess(std::vector<std::string> command, const Options& options)
    : own_group_(options.own_group) {
  posix_spawn_file_actions_t actions{};
  posix_spawnattr_t attributes{};
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawnattr_init(&attributes);
  const FileDescriptor nothing(::open("/dev/null", O_RDONLY | O_CLOEXEC));
  std::vector<FileDescriptor> copies;
  int next = 0;
  for (const int descriptor : options.descriptors) {
    // Via a number beyond all others, so that none is overwritten before it is copied.
    constexpr int kFirstCopy = 16;
    copies.emplace_back(
        ::fcntl(descriptor < 0 ? nothing.get() : descriptor, F_DUPFD_CLOEXEC, kFirstCopy));
    ::posix_spawn_file_actions_adddup2(&actions, copies.back().get(), next++);
  }
  ::posix_spawn_file_actions_addclosefrom_np(&actions, next);
  if (own_group_) ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  std::vector<std::string> environment = environmentWith(options.variables);
  const int error = ::posix_spawnp(&pid_, command.front().c_str(), &actions, &attributes,
                                   pointers(command).data(), pointers(environment).data());
  ::posix_spawnattr_destroy(&attributes);
  ::posix_spawn_file_actions_destroy(&actions);
  if (error == 0) return;
  pid_ = 0;
  throw InputError(fmt::format("{}: cannot be started: {}", command.front(), std::strerror(error)));
}

ChildProcess::~ChildProcess() {
  if (alive()) kill();
}

int ChildProcess::wait(std::chrono::milliseconds grace, const CancelQuery& cancelled) {
  // Readable once the process has ended.
  const FileDescriptor handle(static_cast<int>(::syscall(SYS_pidfd_open, pid_, 0)));
  const auto end = Clock::now() + grace;
  int status = 0;
  while (::waitpid(pid_, &status, WNOHANG) == 0) {
    if (Clock::now() >= end || (cancelled && cancelled())) {
      ::kill(own_group_ ? -pid_ : pid_, SIGKILL);
    }
    pollfd ended{.fd = handle.get(), .events = POLLIN, .revents = 0};
    ::poll(&ended, 1, kWaitMilliseconds);
  }
  pid_ = 0;
  return status;
}

}  // namespace broadmark
