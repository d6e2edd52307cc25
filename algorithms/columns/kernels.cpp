#include "columns/kernels.h"

#include "columns/copies.h"
#include "columns/hits.h"

#if defined(__x86_64__)
#include <immintrin.h>
#elif defined(__aarch64__)
#include <arm_neon.h>
#endif

#define BROADMARK_KERNELS "columns/kernels.inl"
#include "simd/for_each_isa.inl"

namespace broadmark::columns {

const Kernels& kernels(Isa isa) { return simd::kernelsFor(isa); }

}  // namespace broadmark::columns
