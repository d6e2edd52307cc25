#include "simd/sweep_kernels.h"

#define BROADMARK_KERNELS "simd/sweep_kernels.inl"
#include "simd/for_each_isa.inl"

namespace broadmark {

const SweepKernels& sweepKernels(Isa isa) { return simd::kernelsFor(isa); }

}  // namespace broadmark
