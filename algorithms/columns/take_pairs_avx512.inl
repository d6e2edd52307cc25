// Pairs from hits, eight at a time; what becomes of each is as in take_pairs.inl.

inline __m512i each(std::uint64_t value) {
  return _mm512_set1_epi64(static_cast<std::int64_t>(value));
}

/// A copy that begins so many bytes behind the first one.
inline __m128i copyAt(const columns::Copy* copies, std::uint64_t bytes) {
  const char* const at = reinterpret_cast<const char*>(copies) + bytes;
  return _mm_load_si128(reinterpret_cast<const __m128i*>(at));
}
/// Four of them.
inline __m512i fourCopies(const columns::Copy* copies, const std::uint64_t* at) {
  __m512i four = _mm512_castsi128_si512(copyAt(copies, at[0]));
  four = _mm512_inserti32x4(four, copyAt(copies, at[1]), 1);
  four = _mm512_inserti32x4(four, copyAt(copies, at[2]), 2);
  return _mm512_inserti32x4(four, copyAt(copies, at[3]), 3);
}

/// Four pairs of copies, compared as by compareCopies(). A pair is lost if one of its four bits in
/// `lost` is set; so it is with `shared`. The pairs of bodies are the upper halves.
struct FourCompared {
  std::uint32_t lost;
  std::uint32_t shared;
  __m512i pairs;
};
inline FourCompared compareFour(__m512i a, __m512i b) {
  constexpr int kTop = -0x7FFF'FFFF - 1;
  constexpr int kTopOfBytes = kTop | 0x0080'8080;
  constexpr __mmask16 kSweepAxis = 0x3333;
  constexpr __mmask16 kBody = 0x8888;
  const __m512i swapping =
      _mm512_broadcast_i32x4(_mm_setr_epi8(4, 5, 6, 7, 0, 1, 2, 3, 10, 11, 8, 9, 12, 13, 14, 15));
  const __m512i most = _mm512_xor_si512(_mm512_shuffle_epi8(a, swapping), _mm512_set1_epi32(-1));
  const __mmask16 above = _mm512_mask_cmpgt_epi32_mask(kSweepAxis, b, most);
  const __mmask16 elsewhere = _mm512_mask_test_epi32_mask(
      kBody, _mm512_and_si512(a, b), _mm512_set1_epi32(static_cast<int>(~kNumberMask)));
  // Zero where they are the same: on the sweep axis all of a number, in the key one of its bytes.
  // Of such a one, less 1, the highest bit is set, and it was not before.
  const __m512i difference = _mm512_xor_si512(b, most);
  const __m512i ones = _mm512_broadcast_i32x4(_mm_setr_epi32(1, 1, 0x0101'0101, 0));
  const __m512i tops = _mm512_broadcast_i32x4(_mm_setr_epi32(kTop, kTop, kTopOfBytes, 0));
  const __m512i less = _mm512_sub_epi32(difference, ones);
  const __mmask16 shared = _mm512_test_epi32_mask(_mm512_andnot_si512(difference, less), tops);

  const __m512i numbers = _mm512_set1_epi32(kNumberMask);
  const __m512i body_a = _mm512_and_si512(a, numbers);
  const __m512i body_b = _mm512_and_si512(b, numbers);
  return {
      bits(_mm512_kor(above, elsewhere)), bits(shared),
      _mm512_unpackhi_epi32(_mm512_min_epu32(body_a, body_b), _mm512_max_epu32(body_a, body_b))};
}

/// Which of eight have a bit: four bits each, the first four in `low`.
inline unsigned anyOfFour(std::uint32_t low, std::uint32_t high) {
  std::uint32_t bits = low | high << 16;
  bits |= bits >> 2;
  bits |= bits >> 1;
  return _pext_u32(bits, 0x1111'1111);
}

/// Writes those of eight that are in `which`, one after the other; returns where they end.
template <class T>
inline T* storeSome(unsigned which, __m512i eight, T* to) {
  _mm512_storeu_si512(to, _mm512_maskz_compress_epi64(static_cast<__mmask8>(which), eight));
  return to + __builtin_popcount(which);
}

std::size_t takePairs(std::uint64_t* places, std::uint64_t* bits, std::size_t count,
                      const columns::Copy* copies, Pair*& pairs, Pair*& doubtful) {
  static_assert(columns::Kernels::kTakenTogether == 8 && sizeof(Pair) == 8);
  static_assert(kHitLanes == 16 && sizeof(columns::Copy) == 16);
  std::uint64_t* kept_places = places;
  std::uint64_t* kept_bits = bits;
  Pair* sure_end = pairs;
  Pair* doubtful_end = doubtful;
  for (std::size_t k = 0; k < count; k += 8) {
    const unsigned taken = k + 8 <= count ? 0xFF : (1U << (count - k)) - 1;
    const auto lanes = static_cast<__mmask8>(taken);
    const __m512i place = _mm512_maskz_loadu_epi64(lanes, places + k);
    const __m512i of_hits = _mm512_maskz_loadu_epi64(lanes, bits + k);
    const __m512i more = _mm512_and_si512(of_hits, _mm512_sub_epi64(of_hits, each(1)));
    const unsigned keep = avx512::bits(_mm512_test_epi64_mask(more, more));
    kept_places = storeSome(keep, place, kept_places);
    kept_bits = storeSome(keep, more, kept_bits);

    // In bytes: bits are in sixteens, one for each step.
    const __m512i bit =
        _mm512_sub_epi64(each(63), _mm512_lzcnt_epi64(_mm512_xor_si512(of_hits, more)));
    const __m512i row = _mm512_and_si512(place, each(0xFFFF'FFFF));
    const __m512i lane = _mm512_and_si512(bit, each(15));
    const __m512i distance =
        _mm512_add_epi64(_mm512_srli_epi64(place, 32), _mm512_srli_epi64(bit, 4));
    const __m512i i = _mm512_add_epi64(row, lane);
    alignas(64) std::uint64_t at_a[8];
    alignas(64) std::uint64_t at_b[8];
    _mm512_store_si512(at_a, _mm512_maskz_slli_epi64(lanes, i, 4));
    _mm512_store_si512(at_b, _mm512_maskz_slli_epi64(lanes, _mm512_add_epi64(i, distance), 4));

    const FourCompared low = compareFour(fourCopies(copies, at_a), fourCopies(copies, at_b));
    const FourCompared high =
        compareFour(fourCopies(copies, at_a + 4), fourCopies(copies, at_b + 4));
    const unsigned found = taken & ~anyOfFour(low.lost, high.lost);
    const unsigned shared = anyOfFour(low.shared, high.shared);
    const __m512i all = _mm512_permutex2var_epi64(
        low.pairs, _mm512_setr_epi64(1, 3, 5, 7, 9, 11, 13, 15), high.pairs);
    sure_end = storeSome(found & ~shared, all, sure_end);
    doubtful_end = storeSome(found & shared, all, doubtful_end);
  }
  pairs = sure_end;
  doubtful = doubtful_end;
  return static_cast<std::size_t>(kept_places - places);
}
