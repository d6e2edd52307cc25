// Messages about optional parts that a build lacks.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>

#include "broadmark/error.h"
#include "parts.h"

namespace broadmark {

/// "this build has no renderer (BROADMARK_RENDER=OFF)"
inline std::string leftOut(const BuildPart& part) {
  return fmt::format("this build has no {} ({}=OFF)", part.name, part.option);
}
/// Throws InputError if this build lacks the part that `option` needs.
inline void requirePart(const BuildPart& part, std::string_view option) {
  if (!part.included) throw InputError(fmt::format("{}: {}", option, leftOut(part)));
}

}  // namespace broadmark
