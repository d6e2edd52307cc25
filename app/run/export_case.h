// Exports a failing case as a small recording, with a command that reproduces the failure.
#pragma once

#include <filesystem>
#include <string>

#include "broadmark/harness/case.h"

namespace broadmark {

struct Plan;

/// Throws InputError if the scene cannot be recorded to `file`, or if `file` is `original` (may be
/// ""), to fail before a long search.
void requireExportable(const std::filesystem::path& file, const std::filesystem::path& original,
                       const SceneInfo& scene);

/// Shell command that runs a case on a recording and checks it:
/// "broadmark --headless 'FreeFall case.aabbs' --algorithm sap-mt --threads 2 --check full".
std::string reproducingCommand(const Case&, const std::filesystem::path& recording);
/// Same for faults that only `torture` detects: leaks, broken invariants.
std::string tortureCommand(const Case&, const std::filesystem::path& recording);

/// Shrinks the plan's only case, from a results file, instead of running it: writes the smallest
/// recording on which it still fails to `file`, and prints a command that reproduces the failure.
/// Returns the exit status. Throws InputError.
int runExportCase(Plan plan, const std::filesystem::path& file, bool quiet);

}  // namespace broadmark
