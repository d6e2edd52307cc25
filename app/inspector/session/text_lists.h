// Lists typed by the user, separated by commas or spaces.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace broadmark {

/// Splits a list: "kd, sap*".
std::vector<std::string> parseWords(std::string text);

/// Parses counts from 1 to `max`: "1000, 8000". `what` names them in errors. Throws InputError.
std::vector<std::uint32_t> parseCounts(const std::string& text, std::string_view what,
                                       std::uint32_t max);

/// Parses ids and ranges up to `last`: "17, 40-50". `what` names them in errors. Throws InputError.
std::vector<std::uint32_t> parseIds(const std::string& text, std::string_view what,
                                    std::uint32_t last);

}  // namespace broadmark
