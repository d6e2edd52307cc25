// Sending for memory before it is needed.
#pragma once

namespace broadmark {

inline void prefetch(const void* address) {
  __builtin_prefetch(address);
  // GCC takes a loop that does nothing but prefetch for one that does nothing (GCC 12).
  asm volatile("");
}

}  // namespace broadmark
