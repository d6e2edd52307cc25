// Sixteen lanes. The functions are documented in vector_scalar.inl.

inline constexpr std::size_t kLanes = 16;
using Vector = __m512;
using Mask = __mmask16;

inline Vector load(const float* from) { return _mm512_load_ps(from); }
inline Vector broadcast(float value) { return _mm512_set1_ps(value); }
// Comparisons into mask registers run on one port, min and max on two. To use both, the first axis
// is tested by two comparisons, the others by the larger minimum against the smaller maximum:
// equivalent for boxes with min <= max, and false for the padding.
inline Mask overlap(Vector a_min, Vector a_max, Vector b_min, Vector b_max) {
  return _mm512_mask_cmp_ps_mask(_mm512_cmp_ps_mask(a_min, b_max, _CMP_LE_OQ), b_min, a_max,
                                 _CMP_LE_OQ);
}
inline Mask overlap(Mask lanes, Vector a_min, Vector a_max, Vector b_min, Vector b_max) {
  return _mm512_mask_cmp_ps_mask(lanes, _mm512_max_ps(a_min, b_min), _mm512_min_ps(a_max, b_max),
                                 _CMP_LE_OQ);
}
// With `|`, GCC moves each mask to a general-purpose register first.
inline Mask maskOr(Mask a, Mask b) { return _mm512_kor(a, b); }
// Inline assembly, as GCC 12 may spill 16 bits of a mask but reload 32, which lost pairs with
// -O1 -fsanitize=thread.
inline unsigned bits(Mask mask) {
  unsigned number;
  asm("kmovw %1, %0" : "=r"(number) : "k"(mask));
  return number;
}
inline bool none(Mask mask) { return _mm512_kortestz(mask, mask) != 0; }

using Keys = std::uint32_t __attribute__((vector_size(64)));
inline __m512i raw(Keys keys) { return reinterpret_cast<__m512i>(keys); }

// Shuffles: a gather of sixteen floats takes several times as long (Zen 4).
inline void loadCorners(const float* corners, Vector (&axes)[3]) {
  Vector rows[4];  // corners r, r + 4, r + 8 and r + 12
  for (int r = 0; r < 4; ++r) {
    rows[r] = _mm512_castps128_ps512(_mm_loadu_ps(corners + 8 * r));
    rows[r] = _mm512_insertf32x4(rows[r], _mm_loadu_ps(corners + 8 * (r + 4)), 1);
    rows[r] = _mm512_insertf32x4(rows[r], _mm_loadu_ps(corners + 8 * (r + 8)), 2);
    rows[r] = _mm512_insertf32x4(rows[r], _mm_loadu_ps(corners + 8 * (r + 12)), 3);
  }
  const Vector low_01 = _mm512_unpacklo_ps(rows[0], rows[1]);
  const Vector low_23 = _mm512_unpacklo_ps(rows[2], rows[3]);
  axes[0] = _mm512_shuffle_ps(low_01, low_23, 0x44);
  axes[1] = _mm512_shuffle_ps(low_01, low_23, 0xEE);
  axes[2] = _mm512_shuffle_ps(_mm512_unpackhi_ps(rows[0], rows[1]),
                              _mm512_unpackhi_ps(rows[2], rows[3]), 0x44);
}
inline Vector minOf(Vector a, Vector b) { return _mm512_min_ps(a, b); }
inline Vector maxOf(Vector a, Vector b) { return _mm512_max_ps(a, b); }
inline void storeTruncated(Vector value, std::uint32_t* to) {
  _mm512_storeu_si512(to, _mm512_cvttps_epi32(value));
}

#include "simd/vector_common.inl"

inline unsigned equal(Keys a, Keys b) { return bits(_mm512_cmpeq_epi32_mask(raw(a), raw(b))); }
inline unsigned positive(Keys numbers) {
  return bits(_mm512_cmpgt_epi32_mask(raw(numbers), _mm512_setzero_si512()));
}

inline constexpr std::size_t kHitLanes = 16;
inline std::uint64_t hitsAtOffsets(const std::uint32_t* keys, Keys limits, Keys remaining) {
  Mask hits[kHitOffsets];
  for (std::size_t offset = 0; offset < kHitOffsets; ++offset) {
    const __m512i above = _mm512_subs_epu8(_mm512_loadu_si512(keys + offset), raw(limits));
    const Mask in_window =
        _mm512_cmpgt_epi32_mask(raw(remaining), _mm512_set1_epi32(static_cast<int>(offset)));
    hits[offset] = _mm512_mask_testn_epi32_mask(in_window, above, above);
  }
  // Packed in mask registers, as a move out of them per offset takes longer.
  return _cvtmask64_u64(_mm512_kunpackd(_mm512_kunpackw(hits[3], hits[2]),  //
                                        _mm512_kunpackw(hits[1], hits[0])));
}

/// Writes the selected elements contiguously, and up to eight elements in all; returns their end.
template <class T>
inline T* compressStore(unsigned selected, __m512i eight, T* to) {
  _mm512_storeu_si512(to, _mm512_maskz_compress_epi64(static_cast<__mmask8>(selected), eight));
  return to + __builtin_popcount(selected);
}

inline Keys loadSelected(const std::uint32_t* from, unsigned lanes) {
  return reinterpret_cast<Keys>(_mm512_maskz_loadu_epi32(static_cast<__mmask16>(lanes), from));
}
template <class Pair>
inline Pair* storePairs(Pair* to, unsigned lanes, Keys a, Keys b) {
  const __m512i first_half =
      _mm512_setr_epi32(0, 16, 1, 17, 2, 18, 3, 19, 4, 20, 5, 21, 6, 22, 7, 23);
  const __m512i second_half = _mm512_add_epi32(first_half, _mm512_set1_epi32(8));
  to = compressStore(lanes & 0xFF, _mm512_permutex2var_epi32(raw(a), first_half, raw(b)), to);
  return compressStore(lanes >> 8, _mm512_permutex2var_epi32(raw(a), second_half, raw(b)), to);
}

inline void streamStore(float* to, Vector value) { _mm512_stream_ps(to, value); }
inline Vector loadUnaligned(const float* from) { return _mm512_loadu_ps(from); }

inline std::uint64_t linesWithin(const std::uint64_t* const* lines, const std::uint64_t* limits) {
  // Values 5 and 6 are ignored, and of value 7 all but its top bit.
  const __m512i counted = _mm512_setr_epi64(-1, -1, -1, -1, -1, 0, 0, std::int64_t{1} << 63);
  Mask within[8];
  for (int l = 0; l < 8; ++l) {
    const __m512i limit = _mm512_set1_epi64(static_cast<std::int64_t>(limits[l]));
    const __m512i above = _mm512_subs_epu8(_mm512_load_si512(lines[l]), limit);
    within[l] = _mm512_testn_epi64_mask(above, counted);
  }
  const auto pack_four = [&](int l) {
    return _mm512_kunpackw(_mm512_kunpackb(within[l + 3], within[l + 2]),
                           _mm512_kunpackb(within[l + 1], within[l]));
  };
  return _cvtmask64_u64(_mm512_kunpackd(pack_four(4), pack_four(0)));
}
