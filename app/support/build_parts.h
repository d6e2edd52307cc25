// Parts that can be left out of a build, in messages.
#pragma once

#include <string>
#include <string_view>

#include "parts.h"

namespace broadmark {

/// "this build has no renderer (BROADMARK_RENDER=OFF)"
std::string leftOut(const BuildPart&);
/// Throws InputError if a part that `option` needs has been left out of this build.
void requirePart(const BuildPart&, std::string_view option);
}  // namespace broadmark
