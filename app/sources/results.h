// Results files as sources.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "broadmark/algorithm.h"
#include "broadmark/error.h"
#include "broadmark/results/results.h"
#include "sources/source.h"

namespace broadmark {

/// Error for a results file without a chosen case; suggests some ids.
InputError missingCase(const Results&, const std::filesystem::path& results_file);

/// Plan entry that repeats the case of a result on its recording. Throws InputError.
PlanEntry entryOf(const CaseResult& result, const std::filesystem::path& results_file,
                  const std::vector<Algorithm>& algorithms);
/// Reason why entryOf() would fail, as far as can be determined without opening files; "": none
/// found.
std::string obstacleTo(const CaseResult& result, const std::filesystem::path& results_file,
                       const std::vector<Algorithm>& algorithms);

}  // namespace broadmark
