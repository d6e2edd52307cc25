#include "support/program.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <system_error>
#include <thread>

#include "support/places.h"

namespace broadmark::tests {
namespace {

std::string contents(std::FILE* file) {
  std::string text;
  std::array<char, 4096> part{};
  std::rewind(file);
  while (const std::size_t got = std::fread(part.data(), 1, part.size(), file)) {
    text.append(part.data(), got);
  }
  return text;
}

}  // namespace

Program::Program(const std::filesystem::path& directory, const Arguments& arguments,
                 const Surroundings& around)
    : patience_(around.patience) {
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
  std::vector<pid_t> all;
  std::error_code none;  // a thread may end meanwhile
  const std::filesystem::path threads = fmt::format("/proc/{}/task", pid_);
  for (const auto& thread : std::filesystem::directory_iterator(threads, none)) {
    std::ifstream list(thread.path() / "children");
    all.insert(all.end(), std::istream_iterator<pid_t>(list), {});
  }
  return all;
}

bool Program::runs() {
  if (pid_ > 0 && ::waitpid(pid_, &wait_status_, WNOHANG) == pid_) pid_ = 0;
  return pid_ > 0;
}

bool Program::waitUntil(const std::function<bool()>& condition) {
  const auto end = std::chrono::steady_clock::now() + patience_;
  while (!condition()) {
    if (!runs() || std::chrono::steady_clock::now() > end) return condition();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

Ended Program::wait() {
  if (!waitUntil([&] { return !runs(); })) {
    signal(SIGKILL);
    ::waitpid(pid_, &wait_status_, 0);
    pid_ = 0;
  }
  const int status =
      WIFEXITED(wait_status_) ? WEXITSTATUS(wait_status_) : 128 + WTERMSIG(wait_status_);
  Ended ended{.status = status, .out = contents(out_.get())};
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

void Program::enter(const std::filesystem::path& directory, const Surroundings& around,
                    char** argv) const {
  for (const auto& [name, value] : around.environment) ::setenv(name.c_str(), value.c_str(), 1);
  const auto limit = [](auto resource, rlim_t most) {
    const rlimit both{most, most};
    ::setrlimit(resource, &both);
  };
  if (around.largest_file) {
    limit(RLIMIT_FSIZE, *around.largest_file);
    std::signal(SIGXFSZ, SIG_IGN);
  }
  if (around.most_memory) limit(RLIMIT_DATA, *around.most_memory);
  int out = ::fileno(out_.get());
  if (!around.standard_output.empty()) out = ::open(around.standard_output.c_str(), O_WRONLY);
  ::dup2(out, 1);
  ::dup2(::fileno(err_.get()), 2);
  if (::chdir(directory.c_str()) == 0) ::execv(argv[0], argv);
  std::perror(argv[0]);
  ::_exit(127);
}

}  // namespace broadmark::tests
