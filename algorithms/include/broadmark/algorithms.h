// The built-in algorithms.
//
// Example:
//
//   for (const Algorithm& algorithm : builtinAlgorithms()) {
//     if (algorithm.id == "tide") {
//       const std::unique_ptr<BroadPhase> instance = algorithm.create();
//     }
//   }
#pragma once

#include <vector>

#include "broadmark/algorithm.h"

namespace broadmark {

/// All variants of all families, in the order of the list in algorithms/CMakeLists.txt. The list is
/// rebuilt at each call. Which families it has depends on the build's options.
std::vector<Algorithm> builtinAlgorithms();

}  // namespace broadmark
