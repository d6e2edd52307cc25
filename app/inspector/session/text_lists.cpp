#include "inspector/session/text_lists.h"

#include <algorithm>

#include "broadmark/names.h"
#include "request/sweep.h"

namespace broadmark {
namespace {

std::uint32_t toNumber(std::string_view word, std::string_view what, std::uint32_t min,
                       std::uint32_t max) {
  return static_cast<std::uint32_t>(parseInteger(word, what, min, max));
}

}  // namespace

std::vector<std::string> parseWords(std::string text) {
  std::ranges::replace(text, ' ', ',');
  return splitList({text});
}

std::vector<std::uint32_t> parseCounts(const std::string& text, std::string_view what,
                                       std::uint32_t max) {
  std::vector<std::uint32_t> counts;
  for (const std::string& word : parseWords(text)) counts.push_back(toNumber(word, what, 1, max));
  return counts;
}

std::vector<std::uint32_t> parseIds(const std::string& text, std::string_view what,
                                    std::uint32_t last) {
  std::vector<std::uint32_t> ids;
  for (const std::string& word : parseWords(text)) {
    const std::size_t dash = word.find('-', 1);
    const std::uint32_t from = toNumber(word.substr(0, dash), what, 0, last);
    const std::uint32_t to =
        dash == word.npos ? from : toNumber(word.substr(dash + 1), what, 0, last);
    for (std::uint64_t id = from; id <= to; ++id) ids.push_back(static_cast<std::uint32_t>(id));
  }
  return ids;
}

}  // namespace broadmark
