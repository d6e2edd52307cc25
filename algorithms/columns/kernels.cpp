#include "columns/kernels.h"

#include "columns/copies.h"
#include "columns/hits.h"

#define BROADMARK_KERNELS "columns/kernels.inl"
#include "simd/for_each_isa.inl"

namespace broadmark::columns {

const Kernels& kernels(Isa isa) { return simd::kernelsFor(isa); }

}  // namespace broadmark::columns
