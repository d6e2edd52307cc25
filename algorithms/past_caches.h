// Writing past the caches: what is not looked at soon should neither be read before it is written
// nor push out what is needed.
#pragma once

#include <cstddef>
#include <cstring>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace broadmark {

/// Copies to a multiple of 16 bytes. Other threads see it after showCopiesPastCaches().
inline void copyPastCaches(const void* from, std::size_t bytes, void* to) {
  const auto* source = static_cast<const char*>(from);
  auto* target = static_cast<char*>(to);
#if defined(__SSE2__)
  constexpr std::size_t kVector = sizeof(__m128i);
  for (; bytes >= kVector; bytes -= kVector) {
    _mm_stream_si128(reinterpret_cast<__m128i*>(target),
                     _mm_loadu_si128(reinterpret_cast<const __m128i*>(source)));
    source += kVector;
    target += kVector;
  }
#endif
  std::memcpy(target, source, bytes);
}

inline void showCopiesPastCaches() {
#if defined(__SSE2__)
  _mm_sfence();
#endif
}

}  // namespace broadmark
