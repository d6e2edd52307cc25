// One case of a results file, to be run again, looked at or shrunk; and the command that runs it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "recordings.h"
#include "broadmark/error.h"
#include "broadmark/results.h"
#include "broadmark/runner.h"

namespace broadmark {

struct CaseReference {
  CaseResult result;  ///< as the file has it
  Case run;
  Source source;  ///< opening it checks that it is what the case ran on
  /// What was wrong in the first frame that was; nothing for a case without a wrong answer.
  std::optional<FrameDifference> difference;
};

/// The case of this id in a results file (of several the first that failed), its algorithm being
/// one of `known`. Throws InputError.
CaseReference openCase(const std::filesystem::path& results_file, const std::string& id,
                       const std::vector<Algorithm>& known);

/// The complaint about a results file that is given without a case of it.
InputError missingCase(const Results&, const std::filesystem::path& results_file);

/// Throws InputError when no recording can be written to `file`, or when it is `original` itself
/// (which may be ""). To fail before a long search rather than after it.
void requireExportable(const std::filesystem::path& file, const std::filesystem::path& original);

/// The call that runs a case on a recording and checks it, for a shell:
/// "broadmark --headless 'FreeFall case.aabbs' --algorithm sap-mt --threads 2 --check full".
std::string reproducingCommand(const Case&, const std::filesystem::path& recording);

}  // namespace broadmark
