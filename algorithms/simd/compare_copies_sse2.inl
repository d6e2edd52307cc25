// Two copies in a vector each, for SSE2 and AVX2. Functions as explained in vector_scalar.inl.

struct ComparedCopies {
  unsigned overlap;
  unsigned shared;
};
inline ComparedCopies compareCopies(const std::uint32_t* a, const std::uint32_t* b) {
  const __m128i sweep_axis = _mm_setr_epi32(-1, -1, 0, 0);
  const __m128i key = _mm_setr_epi32(0, 0, -1, 0);
  const __m128i of_a = _mm_load_si128(reinterpret_cast<const __m128i*>(a));
  const __m128i of_b = _mm_load_si128(reinterpret_cast<const __m128i*>(b));
  // The first two numbers change places, and so do the halves of the third. First steps are below
  // 2^31 and last ones, counted down, are not: signed comparisons do.
  const __m128i swapped = _mm_shufflehi_epi16(_mm_shuffle_epi32(of_a, 0xE1), 0xB1);
  const __m128i most = _mm_xor_si128(swapped, _mm_set1_epi32(-1));
  const __m128i above = _mm_and_si128(_mm_cmpgt_epi32(of_b, most), sweep_axis);
  const __m128i same = _mm_or_si128(_mm_and_si128(_mm_cmpeq_epi32(of_b, most), sweep_axis),
                                    _mm_and_si128(_mm_cmpeq_epi8(of_b, most), key));
  return {_mm_movemask_epi8(above) == 0 ? 1U : 0U, _mm_movemask_epi8(same) != 0 ? 1U : 0U};
}
