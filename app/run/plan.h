// A command line, resolved once before anything is run: a plain value that is listed, run headless,
// divided into shards or opened in the inspector.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "broadmark/algorithm.h"
#include "sources/source.h"

namespace broadmark {

struct SessionOptions;

struct Plan {
  std::vector<Algorithm> algorithms;  ///< all available ones, plug-ins included
  /// In the order of the command line. The parameters of all cases have been checked.
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

/// Opens the sources and makes the cases. Entries that --filter and --shard leave without cases are
/// kept for the inspector only. Throws InputError.
Plan makePlan(const SessionOptions&);
/// The same with these algorithms, whichever plug-ins the options name.
Plan makePlan(const SessionOptions&, std::vector<Algorithm> algorithms);

/// The ids of all cases, as --list prints them.
std::vector<std::string> caseIds(const Plan&);

}  // namespace broadmark
