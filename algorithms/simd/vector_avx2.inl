// Eight lanes. The functions are documented in vector_scalar.inl.

inline constexpr std::size_t kLanes = 8;
using Vector = __m256;
using Mask = __m256;

inline Vector load(const float* from) { return _mm256_load_ps(from); }
inline Vector broadcast(float value) { return _mm256_set1_ps(value); }
inline Mask overlap(Vector a_min, Vector a_max, Vector b_min, Vector b_max) {
  return _mm256_and_ps(_mm256_cmp_ps(a_min, b_max, _CMP_LE_OQ),
                       _mm256_cmp_ps(b_min, a_max, _CMP_LE_OQ));
}
inline Mask overlap(Mask lanes, Vector a_min, Vector a_max, Vector b_min, Vector b_max) {
  return _mm256_and_ps(lanes, overlap(a_min, a_max, b_min, b_max));
}
inline Mask maskOr(Mask a, Mask b) { return _mm256_or_ps(a, b); }
inline unsigned bits(Mask mask) { return static_cast<unsigned>(_mm256_movemask_ps(mask)); }
inline bool none(Mask mask) { return bits(mask) == 0; }

using Keys = std::uint32_t __attribute__((vector_size(32)));
inline __m256i raw(Keys keys) { return reinterpret_cast<__m256i>(keys); }

inline void loadCorners(const float* corners, Vector (&axes)[3]) {
  Vector rows[4];  // corners r and r + 4
  for (int r = 0; r < 4; ++r) {
    rows[r] = _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(corners + 8 * r)),
                                   _mm_loadu_ps(corners + 8 * (r + 4)), 1);
  }
  const Vector low_01 = _mm256_unpacklo_ps(rows[0], rows[1]);
  const Vector low_23 = _mm256_unpacklo_ps(rows[2], rows[3]);
  axes[0] = _mm256_shuffle_ps(low_01, low_23, 0x44);
  axes[1] = _mm256_shuffle_ps(low_01, low_23, 0xEE);
  axes[2] = _mm256_shuffle_ps(_mm256_unpackhi_ps(rows[0], rows[1]),
                              _mm256_unpackhi_ps(rows[2], rows[3]), 0x44);
}
inline Vector minOf(Vector a, Vector b) { return _mm256_min_ps(a, b); }
inline Vector maxOf(Vector a, Vector b) { return _mm256_max_ps(a, b); }
inline void storeTruncated(Vector value, std::uint32_t* to) {
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), _mm256_cvttps_epi32(value));
}

#include "simd/vector_common.inl"

inline unsigned equal(Keys a, Keys b) {
  return bits(_mm256_castsi256_ps(_mm256_cmpeq_epi32(raw(a), raw(b))));
}
inline unsigned positive(Keys numbers) {
  return bits(_mm256_castsi256_ps(_mm256_cmpgt_epi32(raw(numbers), _mm256_setzero_si256())));
}

/// The keys of the selected lanes; others are 0, and are not read.
inline Keys loadSelected(const std::uint32_t* from, unsigned lanes) {
  const __m256i bit = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
  const __m256i selected =
      _mm256_cmpeq_epi32(_mm256_and_si256(_mm256_set1_epi32(static_cast<int>(lanes)), bit), bit);
  return reinterpret_cast<Keys>(
      _mm256_maskload_epi32(reinterpret_cast<const int*>(from), selected));
}
/// Stores the selected ones of four pairs contiguously, four in all; returns the end of the
/// selected ones.
template <class Pair>
inline Pair* storeFourPairs(Pair* to, unsigned selected, __m256i pairs) {
  static constexpr std::uint32_t kPlaces[16][8] = {
      {0, 1, 0, 1, 0, 1, 0, 1}, {0, 1, 0, 1, 0, 1, 0, 1}, {2, 3, 0, 1, 0, 1, 0, 1},
      {0, 1, 2, 3, 0, 1, 0, 1}, {4, 5, 0, 1, 0, 1, 0, 1}, {0, 1, 4, 5, 0, 1, 0, 1},
      {2, 3, 4, 5, 0, 1, 0, 1}, {0, 1, 2, 3, 4, 5, 0, 1}, {6, 7, 0, 1, 0, 1, 0, 1},
      {0, 1, 6, 7, 0, 1, 0, 1}, {2, 3, 6, 7, 0, 1, 0, 1}, {0, 1, 2, 3, 6, 7, 0, 1},
      {4, 5, 6, 7, 0, 1, 0, 1}, {0, 1, 4, 5, 6, 7, 0, 1}, {2, 3, 4, 5, 6, 7, 0, 1},
      {0, 1, 2, 3, 4, 5, 6, 7}};
  const __m256i places = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(kPlaces[selected]));
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), _mm256_permutevar8x32_epi32(pairs, places));
  return to + __builtin_popcount(selected);
}
/// Stores the pairs (a, b) of the selected lanes contiguously, and possibly up to kLanes pairs
/// behind them; returns their end.
template <class Pair>
inline Pair* storePairs(Pair* to, unsigned lanes, Keys a, Keys b) {
  const __m256i pairs_0145 = _mm256_unpacklo_epi32(raw(a), raw(b));
  const __m256i pairs_2367 = _mm256_unpackhi_epi32(raw(a), raw(b));
  to = storeFourPairs(to, lanes & 15, _mm256_permute2x128_si256(pairs_0145, pairs_2367, 0x20));
  return storeFourPairs(to, lanes >> 4, _mm256_permute2x128_si256(pairs_0145, pairs_2367, 0x31));
}

inline constexpr std::size_t kHitLanes = 4;  // packing works within 128-bit halves
inline std::uint64_t hitsAtOffsets(const std::uint32_t* keys, Keys limits, Keys remaining) {
  __m256i hits[kHitOffsets];
  for (std::size_t offset = 0; offset < kHitOffsets; ++offset) {
    const __m256i above = _mm256_subs_epu8(
        _mm256_loadu_si256(reinterpret_cast<const __m256i*>(keys + offset)), raw(limits));
    hits[offset] = _mm256_and_si256(
        _mm256_cmpeq_epi32(above, _mm256_setzero_si256()),
        _mm256_cmpgt_epi32(raw(remaining), _mm256_set1_epi32(static_cast<int>(offset))));
  }
  const __m256i packed = _mm256_packs_epi16(_mm256_packs_epi32(hits[0], hits[1]),
                                            _mm256_packs_epi32(hits[2], hits[3]));
  return static_cast<unsigned>(_mm256_movemask_epi8(packed));
}

#include "simd/compare_entries_sse2.inl"

inline void streamStore(float* to, Vector value) { _mm256_stream_ps(to, value); }
inline Vector loadUnaligned(const float* from) { return _mm256_loadu_ps(from); }

inline unsigned valuesWithin(const std::uint64_t* line, std::uint64_t limits) {
  const __m256i limit = _mm256_set1_epi64x(static_cast<std::int64_t>(limits));
  const auto* const halves = reinterpret_cast<const __m256i*>(line);
  unsigned within = 0;
  for (int half = 0; half < 2; ++half) {
    const __m256i above = _mm256_subs_epu8(_mm256_load_si256(halves + half), limit);
    const __m256i none = _mm256_cmpeq_epi64(above, _mm256_setzero_si256());
    within |= static_cast<unsigned>(_mm256_movemask_pd(_mm256_castsi256_pd(none))) << 4 * half;
  }
  return within;
}

#include "simd/lines_within.inl"
