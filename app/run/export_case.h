// A failing case as a small recording, and the command that shows the failure on it.
#pragma once

#include <filesystem>
#include <string>

#include "broadmark/harness/case.h"

namespace broadmark {

struct Plan;

/// Throws InputError when no recording of the scene can be written to `file`, or when it is
/// `original` (which may be ""): to fail before a long search rather than after it.
void requireExportable(const std::filesystem::path& file, const std::filesystem::path& original,
                       const SceneInfo& scene);

/// The command that runs a case on a recording and checks it, for a shell:
/// "broadmark --headless 'FreeFall case.aabbs' --algorithm sap-mt --threads 2 --check full".
std::string reproducingCommand(const Case&, const std::filesystem::path& recording);
/// The same for what only a torture notices: a leak, a broken invariant.
std::string torturingCommand(const Case&, const std::filesystem::path& recording);

/// Shrinks the plan's only case, which is of a results file, instead of running it; writes the
/// smallest recording on which it still fails to `file`, and prints the command that shows it.
/// Returns the exit status. Throws InputError.
int runExportCase(Plan plan, const std::filesystem::path& file, bool quiet);

}  // namespace broadmark
