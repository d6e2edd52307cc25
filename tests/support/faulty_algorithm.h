// Algorithms that are wrong once in a while: see faulty_algorithm.cpp.
#pragma once

#include <vector>

#include "broadmark/algorithm.h"

namespace broadmark::faulty {

/// "faulty", which misses pairs, and "faulty-extra", which reports false ones. In changing worlds
/// "lossy-removal", which misses a pair when a body vanishes, and "lossy-layers", which misses
/// those of two layers.
std::vector<Algorithm> variants();

}  // namespace broadmark::faulty
