// Results of several runs as one: shards of a plan, or the same on several machines.
#pragma once

#include <cstddef>
#include <vector>

#include "broadmark/results/results.h"

namespace broadmark {

struct MergedResults {
  Results results;           ///< complete if all of them are
  std::size_t repeated = 0;  ///< cases that were in several of them
};

/// All cases, in their order. A case that was run several times, by the same build on the same
/// machine, is there once: as it was run last, but rather whole than in part. `options` are left to
/// the caller.
MergedResults mergeResults(const std::vector<Results>& runs);

}  // namespace broadmark
