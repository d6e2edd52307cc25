// Sending for memory before it is needed.
#pragma once

#include <cstddef>

namespace broadmark {

/// How many elements ahead to send for what a loop reads in no order: some hundred nanoseconds.
inline constexpr std::size_t kPrefetchAhead = 16;

inline void prefetch(const void* address) {
  __builtin_prefetch(address);
  // GCC takes a loop that does nothing but prefetch for one that does nothing (GCC 12).
  asm volatile("");
}

}  // namespace broadmark
