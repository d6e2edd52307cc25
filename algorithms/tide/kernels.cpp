#include "tide/kernels.h"

#if defined(__x86_64__)
#include <immintrin.h>
#elif defined(__aarch64__)
#include <arm_neon.h>
#endif

#define BROADMARK_KERNELS "tide/kernels.inl"
#include "simd/for_each_isa.inl"

namespace broadmark::tide {

const Kernels& kernels(Isa isa) { return simd::kernelsFor(isa); }

}  // namespace broadmark::tide
