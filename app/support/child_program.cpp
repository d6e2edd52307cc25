#include "support/child_program.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdlib>
#include <cstring>

#include "broadmark/error.h"
#include "broadmark/files.h"
#include "support/words.h"

namespace broadmark {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxOutput = std::size_t{64} << 10;  // bytes; older output is dropped
constexpr int kPollTimeout = 100;                          // milliseconds

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  for (std::string& text : texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

/// The environment of this process with some variables added or replaced.
std::vector<std::string> environment(
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

/// Starts a process in its own process group, with stdout and stderr redirected to `output`.
pid_t spawn(std::vector<std::string> command, std::vector<std::string> environment, int output) {
  posix_spawn_file_actions_t actions{};
  posix_spawnattr_t attributes{};
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawnattr_init(&attributes);
  ::posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  ::posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
  ::posix_spawn_file_actions_adddup2(&actions, output, STDERR_FILENO);
  ::posix_spawn_file_actions_addclosefrom_np(&actions, STDERR_FILENO + 1);
  ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  pid_t pid = 0;
  const int error = ::posix_spawnp(&pid, command.front().c_str(), &actions, &attributes,
                                   pointers(command).data(), pointers(environment).data());
  ::posix_spawnattr_destroy(&attributes);
  ::posix_spawn_file_actions_destroy(&actions);
  if (error != 0) {
    throw InputError(
        fmt::format("{}: cannot be started: {}", command.front(), std::strerror(error)));
  }
  return pid;
}

int statusOf(pid_t pid) {
  int status = 0;
  while (::waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

/// Reads until all writers have closed the pipe. Returns nothing if cancelled before.
std::optional<std::string> readAll(const FileDescriptor& from, const CancelQuery& cancelled) {
  std::string printed;
  std::array<char, 4096> buffer{};
  while (true) {
    if (cancelled && cancelled()) return {};
    pollfd waiting{.fd = from.get(), .events = POLLIN, .revents = 0};
    if (::poll(&waiting, 1, kPollTimeout) <= 0) continue;
    const ssize_t size = ::read(from.get(), buffer.data(), buffer.size());
    if (size < 0 && errno == EINTR) continue;
    if (size <= 0) return printed;
    printed.append(buffer.data(), static_cast<std::size_t>(size));
    if (printed.size() > 2 * kMaxOutput) printed.erase(0, printed.size() - kMaxOutput);
  }
}

}  // namespace

ProgramEnd runProgram(std::vector<std::string> command,
                      const std::vector<std::pair<std::string, std::string>>& variables,
                      const CancelQuery& cancelled) {
  std::array<int, 2> pipe_ends{};
  if (::pipe2(pipe_ends.data(), O_CLOEXEC) != 0) {
    throw InputError(fmt::format("{}: pipe failed: {}", command.front(), std::strerror(errno)));
  }
  const FileDescriptor reading(pipe_ends[0]);
  FileDescriptor writing(pipe_ends[1]);
  const pid_t pid = spawn(std::move(command), environment(variables), writing.get());
  { const FileDescriptor closed = std::move(writing); }
  std::optional<std::string> printed = readAll(reading, cancelled);
  if (!printed) {
    ::kill(-pid, SIGKILL);
    statusOf(pid);
    throw Cancelled();
  }
  return {.status = statusOf(pid), .printed = std::move(*printed)};
}

bool isProgramInPath(const std::string& name) {
  const char* const path = std::getenv("PATH");
  return path != nullptr && std::ranges::any_of(splitAt(':', path), [&](const fs::path& folder) {
           return ::access((folder / name).c_str(), X_OK) == 0;
         });
}

void openWithDesktop(const fs::path& file) {
  if (isSandboxed()) {
    throw InputError(
        fmt::format("{}: scripts may not open files with other programs", file.string()));
  }
  // In its own session, so that the child outlives this program.
  const FileDescriptor null_device(::open("/dev/null", O_WRONLY | O_CLOEXEC));
  const pid_t pid = spawn({"setsid", "--fork", "xdg-open", fs::absolute(file).string()},
                          environment({}), null_device.get());
  if (statusOf(pid) != 0) {
    throw InputError(fmt::format("{}: cannot be opened from here", file.string()));
  }
}

}  // namespace broadmark
