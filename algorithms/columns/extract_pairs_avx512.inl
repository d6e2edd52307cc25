// Pairs from hits, eight at a time; otherwise as in extract_pairs.inl.

inline __m512i broadcast64(std::uint64_t value) {
  return _mm512_set1_epi64(static_cast<std::int64_t>(value));
}

inline __m128i entryAt(const columns::CellEntry* entries, std::uint64_t byte_offset) {
  const char* const at = reinterpret_cast<const char*>(entries) + byte_offset;
  return _mm_load_si128(reinterpret_cast<const __m128i*>(at));
}
inline __m512i fourEntries(const columns::CellEntry* entries, const std::uint64_t* byte_offsets) {
  __m512i four = _mm512_castsi128_si512(entryAt(entries, byte_offsets[0]));
  four = _mm512_inserti32x4(four, entryAt(entries, byte_offsets[1]), 1);
  four = _mm512_inserti32x4(four, entryAt(entries, byte_offsets[2]), 2);
  return _mm512_inserti32x4(four, entryAt(entries, byte_offsets[3]), 3);
}

/// Four pairs of entries, compared as by compareEntries(). In both masks, a pair is set if any of
/// its four bits is. The pairs of body ids are the upper halves.
struct FourComparisons {
  std::uint32_t rejected;
  std::uint32_t ambiguous;
  __m512i pairs;
};
inline FourComparisons compareFour(__m512i a, __m512i b) {
  constexpr int kTopBit = -0x7FFF'FFFF - 1;
  constexpr int kTopBitOfBytes = kTopBit | 0x0080'8080;
  constexpr __mmask16 kSweepAxis = 0x3333;
  constexpr __mmask16 kBody = 0x8888;
  const __m512i swapping =
      _mm512_broadcast_i32x4(_mm_setr_epi8(4, 5, 6, 7, 0, 1, 2, 3, 10, 11, 8, 9, 12, 13, 14, 15));
  const __m512i limits = _mm512_xor_si512(_mm512_shuffle_epi8(a, swapping), _mm512_set1_epi32(-1));
  const __mmask16 apart = _mm512_mask_cmpgt_epi32_mask(kSweepAxis, b, limits);
  const __mmask16 not_home = _mm512_mask_test_epi32_mask(
      kBody, _mm512_and_si512(a, b), _mm512_set1_epi32(static_cast<int>(~kBodyIdMask)));
  // Bounds are equal where the difference is zero: in all of a field on the sweep axis, in a byte
  // of the key. Subtracting 1 from zero sets its top bit, which was clear before.
  const __m512i difference = _mm512_xor_si512(b, limits);
  const __m512i ones = _mm512_broadcast_i32x4(_mm_setr_epi32(1, 1, 0x0101'0101, 0));
  const __m512i tops = _mm512_broadcast_i32x4(_mm_setr_epi32(kTopBit, kTopBit, kTopBitOfBytes, 0));
  const __m512i less = _mm512_sub_epi32(difference, ones);
  const __mmask16 ambiguous = _mm512_test_epi32_mask(_mm512_andnot_si512(difference, less), tops);

  const __m512i id_mask = _mm512_set1_epi32(kBodyIdMask);
  const __m512i id_a = _mm512_and_si512(a, id_mask);
  const __m512i id_b = _mm512_and_si512(b, id_mask);
  return {bits(_mm512_kor(apart, not_home)), bits(ambiguous),
          _mm512_unpackhi_epi32(_mm512_min_epu32(id_a, id_b), _mm512_max_epu32(id_a, id_b))};
}

/// One bit per group of four bits: whether any of them is set. The first four groups are in `low`.
inline unsigned anyOfFour(std::uint32_t low, std::uint32_t high) {
  std::uint32_t bits = low | high << 16;
  bits |= bits >> 2;
  bits |= bits >> 1;
  return _pext_u32(bits, 0x1111'1111);
}

std::size_t extractPairs(std::uint64_t* positions, std::uint64_t* masks, std::size_t count,
                         const columns::CellEntry* entries, Pair*& pairs, Pair*& ambiguous) {
  static_assert(columns::Kernels::kExtractWidth == 8 && sizeof(Pair) == 8);
  static_assert(kHitLanes == 16 && sizeof(columns::CellEntry) == 16);
  std::uint64_t* kept_positions = positions;
  std::uint64_t* kept_masks = masks;
  Pair* pairs_end = pairs;
  Pair* ambiguous_end = ambiguous;
  for (std::size_t k = 0; k < count; k += 8) {
    const unsigned valid = k + 8 <= count ? 0xFF : (1U << (count - k)) - 1;
    const auto lanes = static_cast<__mmask8>(valid);
    const __m512i position = _mm512_maskz_loadu_epi64(lanes, positions + k);
    const __m512i mask = _mm512_maskz_loadu_epi64(lanes, masks + k);
    const __m512i rest = _mm512_and_si512(mask, _mm512_sub_epi64(mask, broadcast64(1)));
    const unsigned keep = avx512::bits(_mm512_test_epi64_mask(rest, rest));
    kept_positions = compressStore(keep, position, kept_positions);
    kept_masks = compressStore(keep, rest, kept_masks);

    // Masks have sixteen bits per offset.
    const __m512i bit =
        _mm512_sub_epi64(broadcast64(63), _mm512_lzcnt_epi64(_mm512_xor_si512(mask, rest)));
    const __m512i row = _mm512_and_si512(position, broadcast64(0xFFFF'FFFF));
    const __m512i lane = _mm512_and_si512(bit, broadcast64(15));
    const __m512i distance =
        _mm512_add_epi64(_mm512_srli_epi64(position, 32), _mm512_srli_epi64(bit, 4));
    const __m512i i = _mm512_add_epi64(row, lane);
    alignas(64) std::uint64_t bytes_i[8];
    alignas(64) std::uint64_t bytes_j[8];
    _mm512_store_si512(bytes_i, _mm512_maskz_slli_epi64(lanes, i, 4));
    _mm512_store_si512(bytes_j, _mm512_maskz_slli_epi64(lanes, _mm512_add_epi64(i, distance), 4));

    const FourComparisons low =
        compareFour(fourEntries(entries, bytes_i), fourEntries(entries, bytes_j));
    const FourComparisons high =
        compareFour(fourEntries(entries, bytes_i + 4), fourEntries(entries, bytes_j + 4));
    const unsigned found = valid & ~anyOfFour(low.rejected, high.rejected);
    const unsigned uncertain = anyOfFour(low.ambiguous, high.ambiguous);
    const __m512i candidates = _mm512_permutex2var_epi64(
        low.pairs, _mm512_setr_epi64(1, 3, 5, 7, 9, 11, 13, 15), high.pairs);
    pairs_end = compressStore(found & ~uncertain, candidates, pairs_end);
    ambiguous_end = compressStore(found & uncertain, candidates, ambiguous_end);
  }
  pairs = pairs_end;
  ambiguous = ambiguous_end;
  return static_cast<std::size_t>(kept_positions - positions);
}
