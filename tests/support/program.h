// Runs the real program as its users do: in a directory of its own, from outside.
#pragma once

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace broadmark::testing {

/// What a program left when it ended.
struct Ended {
  int status = 0;  ///< exit status; 128 + the signal that ended it
  std::string out;
  std::string err;
};

/// What may differ about the surroundings of a program.
struct Surroundings {
  std::map<std::string, std::string> environment;  ///< added to ours
  std::optional<rlim_t> largest_file;              ///< bytes; beyond it writing fails (EFBIG)
  std::string standard_output;                     ///< a file to print to instead of Ended::out
  std::chrono::seconds patience{120};              ///< then it is killed: status 137
};

/// A program that runs. It is killed when this goes.
class Program {
 public:
  using Arguments = std::vector<std::string>;

  Program(const std::filesystem::path& directory, const Arguments& arguments,
          const Surroundings& around = {})
      : patience_(around.patience) {
    std::string program = BROADMARK_PROGRAM;
    std::vector<char*> argv = {program.data()};
    Arguments copies = arguments;
    for (std::string& argument : copies) argv.push_back(argument.data());
    argv.push_back(nullptr);
    pid_ = ::fork();
    if (pid_ < 0) throw std::runtime_error("cannot fork");
    if (pid_ == 0) enter(directory, around, argv.data());
  }
  ~Program() {
    if (pid_ <= 0) return;
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
  }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  void signal(int number) const { ::kill(pid_, number); }
  /// The processes that its main thread has started.
  [[nodiscard]] std::vector<pid_t> children() const {
    std::ifstream list("/proc/" + std::to_string(pid_) + "/task/" + std::to_string(pid_) +
                       "/children");
    return {std::istream_iterator<pid_t>(list), {}};
  }

  /// Whether it has not ended yet.
  [[nodiscard]] bool runs() {
    if (pid_ > 0 && ::waitpid(pid_, &wait_status_, WNOHANG) == pid_) pid_ = 0;
    return pid_ > 0;
  }

  /// Waits until `condition` holds. False when the program ended, or patience did, before.
  template <class Condition>
  bool waitUntil(Condition&& condition) {
    const auto end = std::chrono::steady_clock::now() + patience_;
    while (!condition()) {
      if (!runs() || std::chrono::steady_clock::now() > end) return condition();
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return true;
  }

  Ended wait() {
    if (!waitUntil([&] { return !runs(); })) {
      signal(SIGKILL);
      ::waitpid(pid_, &wait_status_, 0);
      pid_ = 0;
    }
    const int status =
        WIFEXITED(wait_status_) ? WEXITSTATUS(wait_status_) : 128 + WTERMSIG(wait_status_);
    return {status, contents(out_.get()), contents(err_.get())};
  }

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  using File = std::unique_ptr<std::FILE, Close>;

  /// The child's side; does not return.
  [[noreturn]] void enter(const std::filesystem::path& directory, const Surroundings& around,
                          char** argv) const {
    for (const auto& [name, value] : around.environment) ::setenv(name.c_str(), value.c_str(), 1);
    if (around.largest_file) {
      const rlimit limit{*around.largest_file, *around.largest_file};
      ::setrlimit(RLIMIT_FSIZE, &limit);
      std::signal(SIGXFSZ, SIG_IGN);
    }
    int out = ::fileno(out_.get());
    if (!around.standard_output.empty()) out = ::open(around.standard_output.c_str(), O_WRONLY);
    ::dup2(out, 1);
    ::dup2(::fileno(err_.get()), 2);
    if (::chdir(directory.c_str()) == 0) ::execv(argv[0], argv);
    std::perror(argv[0]);
    ::_exit(127);
  }

  static std::string contents(std::FILE* file) {
    std::string text;
    std::array<char, 4096> part{};
    std::rewind(file);
    while (const std::size_t got = std::fread(part.data(), 1, part.size(), file)) {
      text.append(part.data(), got);
    }
    return text;
  }

  File out_{std::tmpfile()};
  File err_{std::tmpfile()};
  std::chrono::seconds patience_;
  pid_t pid_ = 0;
  int wait_status_ = 0;
};

}  // namespace broadmark::testing
