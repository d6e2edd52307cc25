// Delta debugging: Zeller and Hildebrandt, "Simplifying and Isolating Failure-Inducing Input",
// 2002.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace broadmark {

/// Removes chunks of `items`, large ones first, while still_fails(fewer), until no item can be
/// removed; never removes the last `kept` items. Returns whether any was removed.
template <class Item, class Fails>
bool minimize(std::vector<Item> items, std::size_t kept, Fails&& still_fails) {
  const std::size_t initial_size = items.size();
  std::size_t chunk = std::max<std::size_t>(items.size() / 2, 1);
  while (true) {
    const std::size_t before = items.size();
    for (std::size_t begin = 0; begin + kept < items.size();) {
      const std::size_t end = std::min(begin + chunk, items.size() - kept);
      std::vector<Item> fewer = items;
      fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(begin),
                  fewer.begin() + static_cast<std::ptrdiff_t>(end));
      if (still_fails(std::as_const(fewer))) {
        items = std::move(fewer);
      } else {
        begin = end;
      }
    }
    if (chunk == 1 && items.size() == before) return items.size() < initial_size;
    chunk = std::max<std::size_t>(chunk / 2, 1);
  }
}

}  // namespace broadmark
