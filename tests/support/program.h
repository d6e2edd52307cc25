// Runs the real program as its users do: as a process in its own directory.
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

/// Exit status and output of a program that ended.
struct ProgramResult {
  int status = 0;  ///< exit status; 128 + the signal that ended it
  std::string out;
  std::string err;  ///< without warnings
  /// "broadmark: warning: …": they depend on the load of the machine.
  std::vector<std::string> warnings;
};

/// Environment and resource limits of a program.
struct ProgramEnvironment {
  std::map<std::string, std::string> environment;  ///< added to the test's environment
  std::optional<rlim_t> max_file_bytes;            ///< bytes; beyond it writing fails (EFBIG)
  std::optional<rlim_t> max_memory_bytes;          ///< bytes; beyond it allocations fail
  std::string standard_output;                     ///< output file, instead of ProgramResult::out
};

/// A descriptor that poll() reports readable once the process has ended.
FileDescriptor processDescriptor(pid_t process);

/// A running program. The destructor kills it, as does the end of the test process.
class Program {
 public:
  using Arguments = std::vector<std::string>;

  Program(const std::filesystem::path& directory, const Arguments& arguments,
          const ProgramEnvironment& around = {});
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  [[nodiscard]] pid_t id() const { return pid_; }
  void signal(int number) const { ::kill(pid_, number); }
  /// Its child processes.
  [[nodiscard]] std::vector<pid_t> children() const;

  [[nodiscard]] bool isRunning();

  /// Waits until `condition` holds; tests it when the program changes files in its directory or
  /// prints. False if the program ended before.
  bool waitUntil(const std::function<bool()>& condition) const;
  /// Waits until it has printed `text` to standard error, `times` times. False as above.
  bool waitForText(const std::string& text, int times = 1) const;

  ProgramResult wait();

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  using File = std::unique_ptr<std::FILE, Close>;

  /// The child's side; does not return.
  [[noreturn]] void enter(const std::filesystem::path& directory, const ProgramEnvironment& around,
                          char** argv) const;

  File out_{std::tmpfile()};
  File err_{std::tmpfile()};
  std::filesystem::path directory_;
  pid_t pid_ = 0;
  int wait_status_ = 0;
};

}  // namespace broadmark::tests
