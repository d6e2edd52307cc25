// Formatting and parsing of human-readable texts and numbers.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace broadmark {

/// Parses a text that is a number and nothing else.
std::optional<double> numberIn(std::string_view text);

/// "1.25 MB"
std::string bytesText(std::uint64_t bytes);

/// "1 case", "2 cases"; an irregular plural ("bodies") must be given.
std::string counted(std::uint64_t count, std::string_view singular, std::string_view plural = {});

/// Calls visit(part) for each part of the text between separators, including empty parts.
template <class Visit>
void forEachPart(char separator, std::string_view text, const Visit& visit) {
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(separator, begin), text.size());
    visit(text.substr(begin, end - begin));
    begin = end + 1;
  }
}

/// Returns the parts of the text between separators, including empty parts.
std::vector<std::string> splitAt(char separator, std::string_view text);

/// Returns the text with these characters replaced.
std::string escaped(std::string_view text,
                    std::initializer_list<std::pair<char, std::string_view>> replacements);

/// Escapes a text for XML and HTML. Control characters, which XML cannot represent, become blanks.
std::string escapedForXml(std::string text);

/// Quotes a shell word with single quotes if necessary.
std::string shellQuoted(const std::string& text);

/// "3 bodies, 1 frame"
std::string extentText(std::size_t bodies, std::size_t frames);

/// A measured time, with three significant digits: "1.23 ms".
std::string durationText(double seconds);

/// A waiting time: "2 min 05 s".
std::string waitingTime(double seconds);

}  // namespace broadmark
