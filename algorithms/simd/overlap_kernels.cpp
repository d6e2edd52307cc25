#include "simd/overlap_kernels.h"

#if defined(__x86_64__)
#include <immintrin.h>
#elif defined(__aarch64__)
#include <arm_neon.h>
#endif

#define BROADMARK_KERNELS "simd/overlap_kernels.inl"
#include "simd/for_each_isa.inl"

namespace broadmark {

const OverlapKernels& overlapKernels(Isa isa) { return simd::kernelsFor(isa); }

}  // namespace broadmark
