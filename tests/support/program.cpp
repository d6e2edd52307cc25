#include "support/program.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <sstream>
#include <stdexcept>
#include <system_error>

#include "support/folder_watch.h"
#include "support/places.h"

namespace broadmark::tests {
namespace {

std::string contents(std::FILE* file) {
  // The program shares its file offset with this process: reading must not move it.
  std::string text(1 << 12, '\0');
  std::size_t size = 0;
  while ((size = readAll(::fileno(file), std::as_writable_bytes(std::span(text)), 0)) ==
         text.size()) {
    text.resize(2 * size);
  }
  text.resize(size);
  return text;
}

}  // namespace

FileDescriptor processDescriptor(pid_t process) {
  // glibc 2.36 declares pidfd_open() for C only.
  const auto descriptor = static_cast<int>(::syscall(SYS_pidfd_open, process, 0));
  if (descriptor < 0) throw std::runtime_error("cannot watch a process");
  return FileDescriptor(descriptor);
}

Program::Program(const std::filesystem::path& directory, const Arguments& arguments,
                 const ProgramEnvironment& around)
    : directory_(directory) {
  std::string program = places::program();
  std::vector<char*> argv = {program.data()};
  Arguments copies = arguments;
  for (std::string& argument : copies) argv.push_back(argument.data());
  argv.push_back(nullptr);
  pid_ = ::fork();
  if (pid_ < 0) throw std::runtime_error("cannot fork");
  if (pid_ == 0) enter(directory, around, argv.data());
}

Program::~Program() {
  if (pid_ <= 0) return;
  ::kill(pid_, SIGKILL);
  ::waitpid(pid_, nullptr, 0);
}

std::vector<pid_t> Program::children() const {
  std::vector<pid_t> processes;
  std::error_code ignored;  // a thread may end meanwhile
  const std::filesystem::path threads = fmt::format("/proc/{}/task", pid_);
  for (const auto& thread : std::filesystem::directory_iterator(threads, ignored)) {
    std::ifstream list(thread.path() / "children");
    processes.insert(processes.end(), std::istream_iterator<pid_t>(list), {});
  }
  return processes;
}

bool Program::isRunning() {
  if (pid_ > 0 && ::waitpid(pid_, &wait_status_, WNOHANG) == pid_) pid_ = 0;
  return pid_ > 0;
}

bool Program::waitUntil(const std::function<bool()>& condition) const {
  const FolderWatch watch(directory_);
  watch.add(::fileno(err_.get()));
  const FileDescriptor process = processDescriptor(pid_);
  return watch.waitUntil(condition, process.get());
}

bool Program::waitForText(const std::string& text, int times) const {
  return waitUntil([&] {
    const std::string printed = contents(err_.get());
    int found = 0;
    for (std::size_t at = 0; (at = printed.find(text, at)) != std::string::npos; ++at) ++found;
    return found >= times;
  });
}

ProgramResult Program::wait() {
  if (pid_ > 0) ::waitpid(pid_, &wait_status_, 0);
  pid_ = 0;
  const int status =
      WIFEXITED(wait_status_) ? WEXITSTATUS(wait_status_) : 128 + WTERMSIG(wait_status_);
  ProgramResult ended{.status = status, .out = contents(out_.get())};
  std::istringstream lines(contents(err_.get()));
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("broadmark: warning: ")) {
      ended.warnings.push_back(line);
    } else {
      ended.err += line + (lines.eof() ? "" : "\n");
    }
  }
  return ended;
}

void Program::enter(const std::filesystem::path& directory, const ProgramEnvironment& around,
                    char** argv) const {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  for (const auto& [name, value] : around.environment) ::setenv(name.c_str(), value.c_str(), 1);
  const auto limit = [](auto resource, rlim_t max) {
    const rlimit both{max, max};
    ::setrlimit(resource, &both);
  };
  if (around.max_file_bytes) {
    limit(RLIMIT_FSIZE, *around.max_file_bytes);
    std::signal(SIGXFSZ, SIG_IGN);
  }
  if (around.max_memory_bytes) limit(RLIMIT_DATA, *around.max_memory_bytes);
  int out = ::fileno(out_.get());
  if (!around.standard_output.empty()) out = ::open(around.standard_output.c_str(), O_WRONLY);
  ::dup2(out, 1);
  ::dup2(::fileno(err_.get()), 2);
  if (::chdir(directory.c_str()) == 0) ::execv(argv[0], argv);
  std::perror(argv[0]);
  ::_exit(127);
}

}  // namespace broadmark::tests
