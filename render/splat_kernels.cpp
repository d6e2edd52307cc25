#include "splat_kernels.h"

#include "shading.h"

namespace broadmark {
namespace {

// Without a target, the compiler splits the vectors for the build's instruction set.
namespace baseline {
#include "splat_kernels.inl"
}  // namespace baseline

// The target applies only to these functions. A whole file compiled with -mavx2 would contain AVX2
// copies of shared inline functions, and the linker might choose them for the whole program.
#if defined(__x86_64__)
#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("avx2"))), apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx2")
#endif
namespace avx2 {
#include "splat_kernels.inl"
}  // namespace avx2
#if defined(__clang__)
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif
#endif

}  // namespace

const SplatKernels& splatKernels([[maybe_unused]] Isa isa) {
#if defined(__x86_64__)
  if (isa == Isa::avx2 || isa == Isa::avx512) return avx2::kKernels;
#endif
  return baseline::kKernels;
}

}  // namespace broadmark
