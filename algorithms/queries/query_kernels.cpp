#include "queries/query_kernels.h"

#include "prefetch.h"

#define BROADMARK_KERNELS "queries/query_kernels.inl"
#include "simd/for_each_isa.inl"

namespace broadmark::broadphase {

const QueryKernels& queryKernels(Isa isa) { return simd::kernelsFor(isa); }

}  // namespace broadmark::broadphase
