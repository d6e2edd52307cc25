// Other programs that this one calls.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "broadmark/harness/case_executor.h"

namespace broadmark {

/// How a program ended.
struct ProgramEnd {
  int status = 0;       ///< its exit status; killed by a signal: 128 and its number, as in a shell
  std::string printed;  ///< to either output, its last part
};

/// Runs a program, found as a shell finds it, to its end, with these environment variables besides
/// ours. Throws InputError when it cannot be started; when it is cancelled, ends it and what it has
/// started, and throws Cancelled.
ProgramEnd runProgram(std::vector<std::string> command,
                      const std::vector<std::pair<std::string, std::string>>& variables = {},
                      const CancelQuery& cancelled = {});

/// Whether a program of this name can be run.
bool isProgramThere(const std::string& name);

/// Opens a file with whatever the desktop opens such files with, and does not wait for its end.
/// Throws InputError, also while a script is played.
void openByDesktop(const std::filesystem::path& file);

}  // namespace broadmark
