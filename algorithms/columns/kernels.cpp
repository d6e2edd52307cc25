#include "columns/kernels.h"

#include "columns/cell_entries.h"
#include "columns/hit_buffer.h"

#define BROADMARK_KERNELS "columns/kernels.inl"
#include "simd/for_each_isa.inl"

namespace broadmark::columns {

const Kernels& kernels(Isa isa) { return simd::kernelsFor(isa); }

}  // namespace broadmark::columns
