// A run request resolved before running: sources opened, cases created, parameters checked. A plan
// is listed, run headless or opened in the inspector.
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
  std::vector<Algorithm> algorithms;  ///< all available, including plug-ins
  /// In the order of the request's sources, with validated parameters.
  std::vector<PlanEntry> entries;
  /// A results file without a chosen case, for the inspector; `entries` is then empty.
  struct UnchosenCase {
    std::filesystem::path file;
    Results results;
  };
  std::optional<UnchosenCase> unchosen_case;
  /// Cases for an inspector without a source; `entries` is then empty.
  std::vector<Case> cases;
};

enum class PlanUse {
  run,   ///< entries without cases after filter and shard are dropped
  open,  ///< only cases of explicitly named algorithms; a case may be unchosen
};

/// Opens the sources and creates the cases. Throws InputError.
Plan makePlan(const RunRequest&, PlanUse);
/// Same with these algorithms, ignoring the plug-ins of the request.
Plan makePlan(const RunRequest&, PlanUse, std::vector<Algorithm> algorithms);

/// Throws InputError if this processor lacks the instruction sets of all cases. The plan must have
/// entries.
void requireSupportedIsa(const Plan&);

/// Ids of all cases, as printed by --list.
std::vector<std::string> caseIds(const Plan&);

}  // namespace broadmark
