// A run request, resolved once before anything is run: its sources opened, its cases made, its
// parameters checked. It is listed, run headless or opened in the inspector.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "broadmark/algorithm.h"
#include "request/run_request.h"
#include "sources/source.h"

namespace broadmark {

struct Plan {
  RunRequest request;
  std::vector<Algorithm> algorithms;  ///< all available ones, plug-ins included
  /// In the order of the request's sources. The parameters of all cases have been checked.
  std::vector<PlanEntry> entries;
  /// A results file without a chosen case, for the inspector: then there are no entries.
  struct UnchosenCase {
    std::filesystem::path file;
    Results results;
  };
  std::optional<UnchosenCase> unchosen_case;
  /// Cases for the inspector that was given no source: then there are no entries.
  std::vector<Case> cases;
};

enum class PlanUse {
  run,   ///< entries that the filter and the shard leave without cases are dropped
  open,  ///< no cases but those of the algorithms that are named; a case may be unchosen
};

/// Opens the sources and makes the cases. Throws InputError.
Plan makePlan(const RunRequest&, PlanUse);
/// The same with these algorithms, whichever plug-ins the request names.
Plan makePlan(const RunRequest&, PlanUse, std::vector<Algorithm> algorithms);

/// The ids of all cases, as --list prints them.
std::vector<std::string> caseIds(const Plan&);

}  // namespace broadmark
