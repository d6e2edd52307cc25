#include "support/child_program.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>

#include "broadmark/error.h"
#include "broadmark/files.h"
#include "broadmark/harness/child_process.h"
#include "support/words.h"

namespace broadmark {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxOutput = std::size_t{64} << 10;  // bytes; older output is dropped
constexpr int kPollTimeout = 100;                          // milliseconds

constexpr std::chrono::hours kUnlimited{1'000'000};

int exitStatus(int wait_status) {
  return WIFEXITED(wait_status) ? WEXITSTATUS(wait_status) : 128 + WTERMSIG(wait_status);
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
  ChildProcess child(std::move(command), {.descriptors = {-1, writing.get(), writing.get()},
                                          .variables = variables,
                                          .own_group = true});
  {
    const FileDescriptor closed = std::move(writing);
  }
  std::optional<std::string> printed = readAll(reading, cancelled);
  if (!printed) {
    child.kill();
    throw Cancelled();
  }
  return {.status = exitStatus(child.wait(kUnlimited, cancelled)), .printed = std::move(*printed)};
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
  ChildProcess child(
      {"setsid", "--fork", "xdg-open", fs::absolute(file).string()},
      {.descriptors = {-1, null_device.get(), null_device.get()}, .own_group = true});
  if (exitStatus(child.wait(kUnlimited)) != 0) {
    throw InputError(fmt::format("{}: cannot be opened from here", file.string()));
  }
}

}  // namespace broadmark
