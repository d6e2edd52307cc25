// A corner of a box as one vector, in a notation that GCC and clang have for every processor.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

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
#if defined(__SSE2__)
// GCC 12 makes four instructions of what is one.
inline Corner smaller(Corner a, Corner b) { return _mm_min_ps(a, b); }
inline Corner larger(Corner a, Corner b) { return _mm_max_ps(a, b); }
#endif

/// Whether a condition, the result of a comparison, holds on all three axes.
inline bool isEveryAxis(WholeCorner condition) {
#if defined(__SSE2__)
  return (_mm_movemask_ps(std::bit_cast<__m128>(condition)) & 7) == 7;
#else
  return (condition[0] & condition[1] & condition[2]) != 0;
#endif
}

/// Towards 0; all of them must be in the range of an integer.
inline WholeCorner truncated(Corner corner) { return __builtin_convertvector(corner, WholeCorner); }

}  // namespace broadmark
