// Merges results of several runs: shards of a plan, or the same plan on several machines.
#pragma once

#include <cstddef>
#include <vector>

#include "broadmark/results/results.h"

namespace broadmark {

struct MergedResults {
  Results results;           ///< complete if all runs are
  std::size_t repeated = 0;  ///< cases present in several runs
};

/// All cases, in order. Of a case run several times by the same build on the same machine only the
/// latest result is kept, with complete results preferred. `options` are left to the caller.
MergedResults mergeResults(const std::vector<Results>& runs);

}  // namespace broadmark
