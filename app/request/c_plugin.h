// Algorithms of shared libraries with the C interface, broadmark_plugin.h.
#pragma once

#include <string>
#include <vector>

#include "broadmark/algorithm.h"
#include "broadmark_plugin.h"

namespace broadmark {

/// The symbol of the function that such a library exports.
inline constexpr char kCPluginSymbol[] = "broadmark_c_plugin";

/// The algorithms of a library that stays loaded. Throws InputError, with `file`, for another
/// version, no entry, or one without a function that is not optional.
std::vector<Algorithm> algorithmsOf(const broadmark_plugin* plugin, const std::string& file);

}  // namespace broadmark
