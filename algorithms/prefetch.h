// Sending for memory before it is needed, and writing past the caches: what is not looked at soon
// should neither be read before it is written nor push out what is needed.
#pragma once

#include <cstddef>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace broadmark {

/// How many elements ahead to send for what a loop reads in no order: some hundred nanoseconds.
inline constexpr std::size_t kPrefetchAhead = 16;

/// How many for prefetchFar(), of which more can be under way at a time.
inline constexpr std::size_t kPrefetchFarAhead = 128;

inline void prefetch(const void* address) {
  __builtin_prefetch(address);
  // GCC takes a loop that does nothing but prefetch for one that does nothing (GCC 12).
  asm volatile("");
}

/// Sends for it into the second cache only.
inline void prefetchFar(const void* address) {
  constexpr int kReading = 0;
  constexpr int kSecondCache = 2;
  __builtin_prefetch(address, kReading, kSecondCache);
  asm volatile("");
}

/// The same for all of an array, from `begin` up to `end`.
template <class T>
void prefetchFar(const T* begin, const T* end) {
  constexpr std::size_t kCacheLine = 64;
  const auto* const stop = reinterpret_cast<const char*>(end);
  for (const auto* line = reinterpret_cast<const char*>(begin); line < stop; line += kCacheLine) {
    prefetchFar(line);
  }
}

/// Other threads see what was written past the caches once the writer has called this.
inline void showWritesPastCaches() {
#if defined(__SSE2__)
  _mm_sfence();
#endif
}

}  // namespace broadmark
