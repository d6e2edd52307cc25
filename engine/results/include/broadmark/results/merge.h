// Merges results of several runs: shards of a plan, or the same plan on several machines.
#pragma once

#include <cstddef>
#include <vector>

#include "broadmark/results/results.h"

namespace broadmark {

struct MergedResults {
  Results results;           ///< complete if all runs are complete
  std::size_t repeated = 0;  ///< cases present in several runs
};

/// Merges all cases, in order. If the same build ran a case several times on the same machine,
/// retains only the latest result, preferably a complete one. Leaves `options` to the caller.
MergedResults mergeResults(const std::vector<Results>& runs);

}  // namespace broadmark
