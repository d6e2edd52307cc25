#include "inspector/body_selection.h"

#include <algorithm>
#include <utility>

namespace broadmark {

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

void BodySelection::toggle(std::uint32_t body) {
  Bodies bodies = bodies_;
  if (contains(body)) {
    std::erase(bodies, body);
  } else {
    bodies.push_back(body);
  }
  select(std::move(bodies));
}

void BodySelection::visit(Pair pair) {
  select({pair.a, pair.b});
  flyThere();
}

}  // namespace broadmark
