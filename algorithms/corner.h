// A corner of a box as a vector, in a portable notation of GCC and clang.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

#include "broadmark/aabb.h"

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace broadmark {

using Corner = float __attribute__((vector_size(16)));
using WholeCorner = std::int32_t __attribute__((vector_size(16)));

inline Corner cornerOf(const std::array<float, 4>& numbers) {
  return std::bit_cast<Corner>(numbers);
}

inline WholeCorner cornerOf(const std::array<std::int32_t, 4>& numbers) {
  return std::bit_cast<WholeCorner>(numbers);
}

/// Per axis, the second operand if they are unordered (NaN).
template <class AnyCorner>
AnyCorner smaller(AnyCorner a, AnyCorner b) {
  return a < b ? a : b;
}
template <class AnyCorner>
AnyCorner larger(AnyCorner a, AnyCorner b) {
  return a > b ? a : b;
}
#if defined(__SSE2__)
// GCC 12 generates four instructions instead of one.
inline Corner smaller(Corner a, Corner b) { return _mm_min_ps(a, b); }
inline Corner larger(Corner a, Corner b) { return _mm_max_ps(a, b); }
#endif

/// The axes on which a comparison holds: bit i for axis i.
inline unsigned axesWhere(WholeCorner condition) {
#if defined(__SSE2__)
  return static_cast<unsigned>(_mm_movemask_ps(std::bit_cast<__m128>(condition))) & 7;
#else
  return static_cast<unsigned>((condition[0] & 1) | (condition[1] & 2) | (condition[2] & 4));
#endif
}
inline bool isEveryAxis(WholeCorner condition) { return axesWhere(condition) == 7; }

/// As overlaps().
inline bool overlapOnAxes(const Aabb& a, const Aabb& b) {
  return isEveryAxis((cornerOf(a.min) <= cornerOf(b.max)) & (cornerOf(b.min) <= cornerOf(a.max)));
}

/// Truncates; all components must be in the range of an integer.
inline WholeCorner truncated(Corner corner) { return __builtin_convertvector(corner, WholeCorner); }

}  // namespace broadmark
