// The built-in algorithms.
#pragma once

#include <vector>

#include "broadmark/algorithm.h"

namespace broadmark {

/// All variants of all families, in the order of the list in algorithms/CMakeLists.txt.
std::vector<Algorithm> builtinAlgorithms();

}  // namespace broadmark
