#include "tide/kernels.h"

#include "prefetch.h"

#define BROADMARK_KERNELS "tide/kernels.inl"
#include "simd/for_each_isa.inl"

namespace broadmark::tide {

const Kernels& kernels(Isa isa) { return simd::kernelsFor(isa); }

}  // namespace broadmark::tide
