// A corner of a box as one vector, in a notation that GCC and clang have for every processor.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

namespace broadmark {

using Corner = float __attribute__((vector_size(16)));
using WholeCorner = std::int32_t __attribute__((vector_size(16)));

inline Corner cornerOf(const std::array<float, 4>& numbers) {
  return std::bit_cast<Corner>(numbers);
}

/// On each axis the second one where they cannot be compared (NaN).
template <class AnyCorner>
AnyCorner smaller(AnyCorner a, AnyCorner b) {
  return a < b ? a : b;
}
template <class AnyCorner>
AnyCorner larger(AnyCorner a, AnyCorner b) {
  return a > b ? a : b;
}

/// Towards 0; all of them must be in the range of an integer.
inline WholeCorner truncated(Corner corner) { return __builtin_convertvector(corner, WholeCorner); }

}  // namespace broadmark
