#include "inspector/session/body_selection.h"

#include <algorithm>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>

#include "broadmark/names.h"
#include "inspector/session/text_lists.h"

namespace broadmark {

std::vector<std::uint32_t> parseIds(std::string_view text, std::string_view what,
                                    std::uint32_t last) {
  std::vector<std::uint32_t> ids;
  const auto number = [&](std::string_view word) {
    return static_cast<std::uint32_t>(parseInteger(word, what, 0, last));
  };
  for (const std::string& word : wordsIn(text)) {
    const std::size_t dash = word.find('-', 1);
    const std::uint32_t from = number(word.substr(0, dash));
    const std::uint32_t to = dash == word.npos ? from : number(word.substr(dash + 1));
    for (std::uint64_t id = from; id <= to; ++id) ids.push_back(static_cast<std::uint32_t>(id));
  }
  return ids;
}

bool BodySelection::contains(std::uint32_t body) const {
  return std::ranges::binary_search(bodies_, body);
}

void BodySelection::select(Bodies bodies) {
  std::ranges::sort(bodies);
  bodies.erase(std::unique(bodies.begin(), bodies.end()), bodies.end());
  const std::size_t count = body_count();
  std::erase_if(bodies, [&](std::uint32_t body) { return body >= count; });
  bodies_ = std::move(bodies);
  on_select(bodies_);
}

void BodySelection::toggle(const Bodies& bodies) {
  Bodies toggled = bodies_;
  if (std::ranges::all_of(bodies, [this](std::uint32_t body) { return contains(body); })) {
    toggled.clear();
    std::ranges::set_difference(bodies_, bodies, std::back_inserter(toggled));
  } else {
    toggled.insert(toggled.end(), bodies.begin(), bodies.end());
  }
  select(std::move(toggled));
}

void BodySelection::visit(Pair pair) {
  select({pair.a, pair.b});
  flyThere();
}

}  // namespace broadmark
