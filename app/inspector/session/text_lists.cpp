#include "inspector/session/text_lists.h"

#include <algorithm>

#include "broadmark/names.h"

namespace broadmark {

std::vector<std::string> wordsIn(std::string_view text) {
  std::vector<std::string> words;
  for (std::size_t start = 0; start <= text.size();) {
    const std::size_t end = std::min(text.find_first_of(", ", start), text.size());
    if (end > start) words.emplace_back(text.substr(start, end - start));
    start = end + 1;
  }
  return words;
}

std::vector<std::uint32_t> countsIn(std::string_view text, std::string_view what,
                                    std::uint32_t most) {
  std::vector<std::uint32_t> counts;
  for (const std::string& word : wordsIn(text)) {
    counts.push_back(static_cast<std::uint32_t>(parseInteger(word, what, 1, most)));
  }
  return counts;
}

}  // namespace broadmark
