// Half-open ranges of indices, and their division among workers.
//
// Example:
//
//   std::size_t sum = 0;
//   const Range second = share(10, 3, 1);  // [3, 6)
//   for (std::size_t i = second.begin; i < second.end; ++i) sum += i;
#pragma once

#include <cstddef>

namespace broadmark {

/// The indices [begin, end).
struct Range {
  std::size_t begin = 0;
  std::size_t end = 0;

  [[nodiscard]] constexpr std::size_t size() const { return end - begin; }
};

/// The part-th, from 0, of `parts` contiguous shares of [0, count). Their sizes differ by one at
/// most. Requires that count · parts fits into a std::size_t.
constexpr Range share(std::size_t count, int parts, int part) {
  const auto n = static_cast<std::size_t>(parts);
  const auto k = static_cast<std::size_t>(part);
  return {count * k / n, count * (k + 1) / n};
}

}  // namespace broadmark
