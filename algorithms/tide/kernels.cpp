#include "tide/kernels.h"

#if defined(__x86_64__)
#include <immintrin.h>
#elif defined(__aarch64__)
#include <arm_neon.h>
#endif

#if defined(__GNUC__) && !defined(__clang__)
// GCC 12 takes the undefined operand inside its own AVX-512 intrinsics for ours (GCC bug 105593).
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif

#define BROADMARK_KERNELS "tide/kernels.inl"
#include "simd/for_each_isa.inl"

namespace broadmark::tide {

const Kernels& kernels(Isa isa) { return simd::kernelsFor(isa); }

}  // namespace broadmark::tide
