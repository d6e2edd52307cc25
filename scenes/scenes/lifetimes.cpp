#include "scenes/lifetimes.h"

namespace broadmark::scenes {

void Lifetimes::reset(std::size_t first, std::size_t end) {
  free_.clear();
  ends_ = {};
  for (std::size_t id = end; id > first; --id) free_.push_back(id - 1);
}

std::optional<std::size_t> Lifetimes::take(std::uint32_t last) {
  if (free_.empty()) return {};
  const std::size_t id = free_.back();
  free_.pop_back();
  ends_.emplace(last, id);
  return id;
}

void Lifetimes::removeOld(Bodies& bodies, std::uint32_t frame) {
  while (!ends_.empty() && ends_.top().first <= frame) {
    const std::size_t id = ends_.top().second;
    ends_.pop();
    bodies.remove(id);
    free_.push_back(id);
  }
}

}  // namespace broadmark::scenes
