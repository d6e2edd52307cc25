// Lists as they are typed: words between commas or spaces.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace broadmark {

/// "kd, sap*"
std::vector<std::string> wordsIn(std::string_view text);

/// "1000, 8000": `what`, each from 1 to `most`. Throws InputError.
std::vector<std::uint32_t> countsIn(std::string_view text, std::string_view what,
                                    std::uint32_t most);

}  // namespace broadmark
