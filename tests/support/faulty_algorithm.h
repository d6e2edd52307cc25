// Algorithms that are wrong once in a while: see faulty_algorithm.cpp.
#pragma once

#include <vector>

#include "broadmark/algorithm.h"

namespace broadmark::faulty {

/// "faulty", which misses pairs, and "faulty-extra", which reports false ones.
std::vector<Algorithm> variants();

}  // namespace broadmark::faulty
