// Two entries in a vector each, for SSE2 and AVX2. The functions are documented in
// vector_scalar.inl.

struct EntryComparison {
  unsigned overlap;
  unsigned ambiguous;
};
inline EntryComparison compareEntries(const std::uint32_t* a, const std::uint32_t* b) {
  const __m128i sweep_axis = _mm_setr_epi32(-1, -1, 0, 0);
  const __m128i key = _mm_setr_epi32(0, 0, -1, 0);
  const __m128i entry_a = _mm_load_si128(reinterpret_cast<const __m128i*>(a));
  const __m128i entry_b = _mm_load_si128(reinterpret_cast<const __m128i*>(b));
  // Swaps the first two fields, and the halves of the third. Lower bounds are below 2^31 and
  // complemented upper bounds are not, so signed comparisons are correct.
  const __m128i swapped = _mm_shufflehi_epi16(_mm_shuffle_epi32(entry_a, 0xE1), 0xB1);
  const __m128i limits = _mm_xor_si128(swapped, _mm_set1_epi32(-1));
  const __m128i apart = _mm_and_si128(_mm_cmpgt_epi32(entry_b, limits), sweep_axis);
  const __m128i equal_bounds =
      _mm_or_si128(_mm_and_si128(_mm_cmpeq_epi32(entry_b, limits), sweep_axis),
                   _mm_and_si128(_mm_cmpeq_epi8(entry_b, limits), key));
  return {_mm_movemask_epi8(apart) == 0 ? 1U : 0U, _mm_movemask_epi8(equal_bounds) != 0 ? 1U : 0U};
}
