// Writing past the caches: what is not looked at soon should neither be read before it is written
// nor push out what is needed. Kernels do it (storePastCaches() in simd/vector_*.inl).
#pragma once

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace broadmark {

/// Other threads see what was written past the caches once the writer has called this.
inline void showWritesPastCaches() {
#if defined(__SSE2__)
  _mm_sfence();
#endif
}

}  // namespace broadmark
