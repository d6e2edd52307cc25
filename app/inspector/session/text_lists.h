// Lists as they are typed: words between commas or spaces.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace broadmark {

/// "kd, sap*"
std::vector<std::string> wordsIn(std::string text);

/// "1000, 8000": `what`, each from 1 to `most`. Throws InputError.
std::vector<std::uint32_t> countsIn(const std::string& text, std::string_view what,
                                    std::uint32_t most);

/// Ids, "17, 40-50": `what`, each at most `last`. Throws InputError.
std::vector<std::uint32_t> parseIds(const std::string& text, std::string_view what,
                                    std::uint32_t last);

}  // namespace broadmark
