// Compiles the file named by BROADMARK_KERNELS once for each instruction set, in the namespaces
// broadmark::simd::scalar, sse2, avx2 and avx512 (on ARM scalar and neon, in WebAssembly scalar and
// simd128), each with its own Vector (vector_*.inl). BROADMARK_AVX512 is defined while compiling
// for AVX-512, BROADMARK_STORES_PAIRS for instruction sets with loadSelected() and storePairs().
//
// Only these functions are compiled for a target: with -mavx2 for a whole file, the linker might
// keep the AVX2 versions of shared inline functions for the entire program. So kernels must not
// instantiate anything from a standard header, and all headers but those of the intrinsics must
// have been included before.

#if defined(__x86_64__)
#include <immintrin.h>
#elif defined(__aarch64__)
#include <arm_neon.h>
#elif defined(__wasm_simd128__)
#include <wasm_simd128.h>
#endif

#if defined(__GNUC__) && !defined(__clang__)
// GCC 12 warns about the undefined operand of its own AVX-512 intrinsics (GCC bug 105593).
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#pragma GCC diagnostic ignored "-Wuninitialized"  // under sanitizers
#endif

#define BROADMARK_PRAGMA(text) _Pragma(#text)
#if defined(__clang__)
#define BROADMARK_TARGET_BEGIN(isa) \
  BROADMARK_PRAGMA(clang attribute push(__attribute__((target(isa))), apply_to = function))
#define BROADMARK_TARGET_END BROADMARK_PRAGMA(clang attribute pop)
#else
#define BROADMARK_TARGET_BEGIN(isa) \
  BROADMARK_PRAGMA(GCC push_options) BROADMARK_PRAGMA(GCC target(isa))
#define BROADMARK_TARGET_END BROADMARK_PRAGMA(GCC pop_options)
#endif

namespace broadmark::simd {
namespace {

namespace scalar {
#include "simd/vector_scalar.inl"
#include BROADMARK_KERNELS
}  // namespace scalar

#if defined(__x86_64__)

BROADMARK_TARGET_BEGIN("sse2")
namespace sse2 {
#include "simd/vector_sse2.inl"
#include BROADMARK_KERNELS
}  // namespace sse2
BROADMARK_TARGET_END

#define BROADMARK_STORES_PAIRS
BROADMARK_TARGET_BEGIN("avx2")
namespace avx2 {
#include "simd/vector_avx2.inl"
#include BROADMARK_KERNELS
}  // namespace avx2
BROADMARK_TARGET_END

BROADMARK_TARGET_BEGIN("avx512f,avx512bw,avx512cd,bmi2,popcnt")
#define BROADMARK_AVX512
namespace avx512 {
#include "simd/vector_avx512.inl"
#include BROADMARK_KERNELS
}  // namespace avx512
#undef BROADMARK_AVX512
#undef BROADMARK_STORES_PAIRS
BROADMARK_TARGET_END

#elif defined(__aarch64__)

namespace neon {  // part of the baseline: no target to set
#include "simd/vector_neon.inl"
#include BROADMARK_KERNELS
}  // namespace neon

#elif defined(__wasm_simd128__)

namespace simd128 {  // a flag of the whole program: no target to set
#include "simd/vector_simd128.inl"
#include BROADMARK_KERNELS
}  // namespace simd128

#endif

/// kKernels for an instruction set, which this processor must support.
const auto& kernelsFor(Isa isa) {
  switch (isa) {
#if defined(__x86_64__)
    case Isa::sse2:
      return sse2::kKernels;
    case Isa::avx2:
      return avx2::kKernels;
    case Isa::avx512:
      return avx512::kKernels;
#elif defined(__aarch64__)
    case Isa::neon:
      return neon::kKernels;
#elif defined(__wasm_simd128__)
    case Isa::simd128:
      return simd128::kKernels;
#endif
    default:
      return scalar::kKernels;
  }
}

}  // namespace
}  // namespace broadmark::simd

#undef BROADMARK_TARGET_BEGIN
#undef BROADMARK_TARGET_END
#undef BROADMARK_PRAGMA
