// A corner of a box as one vector, in a notation that GCC and clang have for every processor.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

namespace broadmark {

using Corner = float __attribute__((vector_size(16)));

inline Corner cornerOf(const std::array<float, 4>& numbers) {
  return std::bit_cast<Corner>(numbers);
}

/// On each axis the second one where they cannot be compared (NaN).
inline Corner smaller(Corner a, Corner b) { return a < b ? a : b; }
inline Corner larger(Corner a, Corner b) { return a > b ? a : b; }

/// Towards 0; all of them must be in the range of an integer.
inline std::array<std::int32_t, 4> truncated(Corner corner) {
  using Integers = std::int32_t __attribute__((vector_size(16)));
  return std::bit_cast<std::array<std::int32_t, 4>>(__builtin_convertvector(corner, Integers));
}

}  // namespace broadmark
