#include "support/build_parts.h"

#include <fmt/format.h>

#include "broadmark/error.h"

namespace broadmark {

std::string leftOut(const BuildPart& part) {
  return fmt::format("this build has no {} ({}=OFF)", part.name, part.option);
}

void requirePart(const BuildPart& part, std::string_view option) {
  if (!part.included) throw InputError(fmt::format("{}: {}", option, leftOut(part)));
}

}  // namespace broadmark
