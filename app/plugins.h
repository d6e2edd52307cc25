// Which algorithms there are: the built-in ones, and those of shared libraries loaded with
// --plugin.
#pragma once

#include <string>
#include <vector>

#include "broadmark/algorithm.h"

namespace broadmark {

/// The built-in algorithms, then those of the libraries in these files (see broadmark/plugin.h),
/// which stay loaded until the program ends. Throws InputError for a file that is no such library,
/// that was built with other headers, or that brings an algorithm without a proper name of its own.
std::vector<Algorithm> availableAlgorithms(const std::vector<std::string>& plugins);

}  // namespace broadmark
