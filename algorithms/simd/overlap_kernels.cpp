#include "simd/overlap_kernels.h"

#define BROADMARK_KERNELS "simd/overlap_kernels.inl"
#include "simd/for_each_isa.inl"

namespace broadmark {

const OverlapKernels& overlapKernels(Isa isa) { return simd::kernelsFor(isa); }

}  // namespace broadmark
