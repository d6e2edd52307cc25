// Runs other programs.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "broadmark/harness/case_executor.h"

namespace broadmark {

/// Exit status and output of a program.
struct ProgramEnd {
  int status = 0;       ///< 128 + signal number if a signal killed the program, as in a shell
  std::string printed;  ///< the end of its output on stdout and stderr
};

/// Runs a program, searched for in PATH, until it exits, with these environment variables added to
/// our own. Throws InputError if it cannot be started. When cancelled, kills the program and its
/// children, and throws Cancelled.
ProgramEnd runProgram(std::vector<std::string> command,
                      const std::vector<std::pair<std::string, std::string>>& variables = {},
                      const CancelQuery& cancelled = {});

/// Whether PATH has an executable program of this name.
bool isProgramInPath(const std::string& name);

/// Opens a file with the desktop's default program, without waiting for it to exit. Throws
/// InputError, also while a script is running.
void openWithDesktop(const std::filesystem::path& file);

}  // namespace broadmark
