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

/// The complaint about a results file without a chosen case; names some that can be chosen.
InputError missingCase(const Results&, const std::filesystem::path& results_file);

/// A result's case, on what it ran on, to be run again. Throws InputError.
PlanEntry entryOf(const CaseResult& result, const std::filesystem::path& results_file,
                  const std::vector<Algorithm>& algorithms);
/// Why entryOf() would fail, as far as that can be told without opening anything; "": nothing is
/// known that stands in the way.
std::string obstacleTo(const CaseResult& result, const std::filesystem::path& results_file,
                       const std::vector<Algorithm>& algorithms);

}  // namespace broadmark
