// What a command line comes to, resolved once before anything is run: a plain value, which is
// listed, run headless, divided into shards or opened in the inspector.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "broadmark/algorithm.h"
#include "sources/source.h"

namespace broadmark {

struct SessionOptions;

struct Plan {
  std::vector<Algorithm> algorithms;  ///< that there are, plug-ins included
  /// In the order of the command line; all cases with checked parameters.
  std::vector<PlanEntry> entries;
  /// A results file one of whose cases is to be chosen in the inspector: then there are no entries.
  std::filesystem::path results;
};

/// Opens the sources and makes the cases. Throws InputError.
Plan makePlan(const SessionOptions&);

}  // namespace broadmark
