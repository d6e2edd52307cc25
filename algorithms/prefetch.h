// Software prefetching, and the fence after non-temporal ("streaming") stores.
#pragma once

#include <cstddef>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace broadmark {

/// How many elements ahead a loop with random access prefetches: some hundred nanoseconds.
inline constexpr std::size_t kPrefetchDistance = 16;

/// The distance for prefetchL2(), of which more can be in flight.
inline constexpr std::size_t kPrefetchL2Distance = 128;

inline void prefetch(const void* address) {
  __builtin_prefetch(address);
  // GCC 12 removes a loop that only prefetches, as if it had no effect.
  asm volatile("");
}

/// Prefetches into L2 but not L1.
inline void prefetchL2(const void* address) {
  constexpr int kRead = 0;
  constexpr int kL2 = 2;
  __builtin_prefetch(address, kRead, kL2);
  asm volatile("");
}

/// Prefetches the array [begin, end) into L2.
template <class T>
void prefetchL2(const T* begin, const T* end) {
  constexpr std::size_t kCacheLine = 64;
  const auto* const stop = reinterpret_cast<const char*>(end);
  for (const auto* line = reinterpret_cast<const char*>(begin); line < stop; line += kCacheLine) {
    prefetchL2(line);
  }
}

/// Makes this thread's non-temporal stores visible to other threads.
inline void streamFence() {
#if defined(__SSE2__)
  _mm_sfence();
#endif
}

}  // namespace broadmark
