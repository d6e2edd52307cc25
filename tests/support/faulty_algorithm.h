// Algorithms that are wrong occasionally: see faulty_algorithm.cpp.
#pragma once

#include <vector>

#include "broadmark/algorithm.h"

namespace broadmark::faulty {

/// "faulty" misses pairs, "faulty-extra" reports false pairs. In changing worlds, "lossy-removal"
/// misses a pair when a body vanishes, "lossy-layers" misses pairs of two layers, and
/// "stale-filter" ignores changes of the collision filter.
std::vector<Algorithm> variants();

/// "short-ids" is wrong only with more than 65,536 bodies, "late-fault" only after frame 40.
std::vector<Algorithm> rareVariants();

}  // namespace broadmark::faulty
