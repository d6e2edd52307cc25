// Bodies with limited lifetimes, and reuse of their ids.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <queue>
#include <utility>
#include <vector>

#include "broadmark/scenes/bodies.h"

namespace broadmark::scenes {

/// The free ids of a range, and the end times of the others. Reuses the most recently freed id
/// first, often in the same frame.
class Lifetimes {
 public:
  /// Frees exactly the ids [first, end).
  void reset(std::size_t first, std::size_t end) {
    free_.clear();
    ends_ = {};
    for (std::size_t id = end; id > first; --id) free_.push_back(id - 1);
  }
  /// Allocates a free id until removeOld() is called for frame `last` or later; nullopt: none is
  /// free.
  std::optional<std::size_t> allocate(std::uint32_t last) {
    if (free_.empty()) return {};
    const std::size_t id = free_.back();
    free_.pop_back();
    ends_.emplace(last, id);
    return id;
  }
  /// Removes the bodies that expire after frame `frame`.
  void removeOld(Bodies& bodies, std::uint32_t frame) {
    while (!ends_.empty() && ends_.top().first <= frame) {
      const std::size_t id = ends_.top().second;
      ends_.pop();
      bodies.remove(id);
      free_.push_back(id);
    }
  }

 private:
  using End = std::pair<std::uint32_t, std::size_t>;  ///< frame, id

  std::vector<std::size_t> free_;
  std::priority_queue<End, std::vector<End>, std::greater<>> ends_;
};

}  // namespace broadmark::scenes
