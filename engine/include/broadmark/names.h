// Names that people type: finding what they meant.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace broadmark {

/// The known name with the smallest edit distance to `name`, or "" when none is near.
std::string nearestName(std::string_view name, std::span<const std::string> known);

/// «unknown KIND 'NAME'; did you mean 'NEAREST'? (one of: …)»
std::string unknownName(std::string_view kind, std::string_view name,
                        std::span<const std::string> known);

/// Shell-style match of a whole word: * and ?.
bool globMatches(std::string_view glob, std::string_view word);

/// The text as an integer in [min, max]. Throws InputError naming `what` otherwise.
long long parseInteger(std::string_view text, std::string_view what, long long min, long long max);

}  // namespace broadmark
