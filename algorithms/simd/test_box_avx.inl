// A box in one vector of AVX, for AVX2 and AVX-512. Functions as explained in vector_scalar.inl.

/// Of upper bounds the opposite, so that one comparison does for both.
using TestBox = __m256;
inline __m256 upperNegated(__m256 box) {
  return _mm256_xor_ps(box, _mm256_setr_ps(0, 0, 0, 0, -0.0F, -0.0F, -0.0F, -0.0F));
}
inline TestBox testBox(const float* box) {
  const __m256 bounds = _mm256_loadu_ps(box);
  return upperNegated(_mm256_permute2f128_ps(bounds, bounds, 1));
}
inline unsigned meets(const float* box, const TestBox& other) {
  const __m256 on_axes = _mm256_cmp_ps(upperNegated(_mm256_loadu_ps(box)), other, _CMP_LE_OQ);
  return (static_cast<unsigned>(_mm256_movemask_ps(on_axes)) & 0x77) == 0x77 ? 1 : 0;
}
