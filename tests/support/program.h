// Runs the real program as its users do: in a directory of its own, from outside.
#pragma once

#include <sys/resource.h>

#include <csignal>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "broadmark/files.h"

namespace broadmark::tests {

/// What a program left when it ended.
struct Ended {
  int status = 0;  ///< exit status; 128 + the signal that ended it
  std::string out;
  std::string err;  ///< but for the lines below
  /// "broadmark: warning: …": they depend on what else the machine does.
  std::vector<std::string> warnings;
};

/// What may differ about the surroundings of a program.
struct Surroundings {
  std::map<std::string, std::string> environment;  ///< added to ours
  std::optional<rlim_t> largest_file;              ///< bytes; beyond it writing fails (EFBIG)
  std::optional<rlim_t> most_memory;               ///< bytes; beyond it there is none
  std::string standard_output;                     ///< a file to print to instead of Ended::out
};

/// Readable, as poll() says, once the process has ended.
FileDescriptor processDescriptor(pid_t process);

/// A program that runs. It is killed when this goes, and when the test is.
class Program {
 public:
  using Arguments = std::vector<std::string>;

  Program(const std::filesystem::path& directory, const Arguments& arguments,
          const Surroundings& around = {});
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  [[nodiscard]] pid_t id() const { return pid_; }
  void signal(int number) const { ::kill(pid_, number); }
  /// The processes that it has started.
  [[nodiscard]] std::vector<pid_t> children() const;

  /// Whether it has not ended yet.
  [[nodiscard]] bool runs();

  /// Waits until `condition` on the files in its directory, or on what it prints, holds. False
  /// when the program ended before.
  bool waitUntil(const std::function<bool()>& condition) const;
  /// Waits until it has printed `text` to standard error, `times` times. False as above.
  bool waitForText(const std::string& text, int times = 1) const;

  Ended wait();

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  using File = std::unique_ptr<std::FILE, Close>;

  /// The child's side; does not return.
  [[noreturn]] void enter(const std::filesystem::path& directory, const Surroundings& around,
                          char** argv) const;

  File out_{std::tmpfile()};
  File err_{std::tmpfile()};
  std::filesystem::path directory_;
  pid_t pid_ = 0;
  int wait_status_ = 0;
};

}  // namespace broadmark::tests
