// Half-open ranges of indices, and their division among workers.
#pragma once

#include <cstddef>

namespace broadmark {

/// The indices [begin, end).
struct Range {
  std::size_t begin = 0;
  std::size_t end = 0;

  [[nodiscard]] constexpr std::size_t size() const { return end - begin; }
};

/// The part-th of `parts` nearly equal, contiguous shares of [0, count).
constexpr Range share(std::size_t count, int parts, int part) {
  const auto n = static_cast<std::size_t>(parts);
  const auto k = static_cast<std::size_t>(part);
  return {count * k / n, count * (k + 1) / n};
}

}  // namespace broadmark
