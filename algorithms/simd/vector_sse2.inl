// Four lanes. The functions are documented in vector_scalar.inl.

inline constexpr std::size_t kLanes = 4;
using Vector = __m128;
using Mask = __m128;

inline Vector load(const float* from) { return _mm_load_ps(from); }
inline Vector broadcast(float value) { return _mm_set1_ps(value); }
inline Mask overlap(Vector a_min, Vector a_max, Vector b_min, Vector b_max) {
  return _mm_and_ps(_mm_cmple_ps(a_min, b_max), _mm_cmple_ps(b_min, a_max));
}
inline Mask overlap(Mask lanes, Vector a_min, Vector a_max, Vector b_min, Vector b_max) {
  return _mm_and_ps(lanes, overlap(a_min, a_max, b_min, b_max));
}
inline Mask maskOr(Mask a, Mask b) { return _mm_or_ps(a, b); }
inline unsigned bits(Mask mask) { return static_cast<unsigned>(_mm_movemask_ps(mask)); }
inline bool none(Mask mask) { return bits(mask) == 0; }

using Keys = std::uint32_t __attribute__((vector_size(16)));
inline __m128i raw(Keys keys) { return reinterpret_cast<__m128i>(keys); }

inline void loadCorners(const float* corners, Vector (&axes)[3]) {
  Vector rows[4];
  for (int r = 0; r < 4; ++r) rows[r] = _mm_loadu_ps(corners + 8 * r);
  _MM_TRANSPOSE4_PS(rows[0], rows[1], rows[2], rows[3]);
  for (int axis = 0; axis < 3; ++axis) axes[axis] = rows[axis];
}
inline Vector minOf(Vector a, Vector b) { return _mm_min_ps(a, b); }
inline Vector maxOf(Vector a, Vector b) { return _mm_max_ps(a, b); }
inline void storeTruncated(Vector value, std::uint32_t* to) {
  _mm_storeu_si128(reinterpret_cast<__m128i*>(to), _mm_cvttps_epi32(value));
}

#include "simd/vector_common.inl"

inline unsigned equal(Keys a, Keys b) {
  return bits(_mm_castsi128_ps(_mm_cmpeq_epi32(raw(a), raw(b))));
}
inline unsigned positive(Keys numbers) {
  return bits(_mm_castsi128_ps(_mm_cmpgt_epi32(raw(numbers), _mm_setzero_si128())));
}

inline constexpr std::size_t kHitLanes = 4;
inline std::uint64_t hitsAtOffsets(const std::uint32_t* keys, Keys limits, Keys remaining) {
  __m128i hits[kHitOffsets];
  for (std::size_t offset = 0; offset < kHitOffsets; ++offset) {
    const __m128i above = _mm_subs_epu8(raw(loadKeys(keys + offset)), raw(limits));
    hits[offset] =
        _mm_and_si128(_mm_cmpeq_epi32(above, _mm_setzero_si128()),
                      _mm_cmpgt_epi32(raw(remaining), _mm_set1_epi32(static_cast<int>(offset))));
  }
  const __m128i packed =
      _mm_packs_epi16(_mm_packs_epi32(hits[0], hits[1]), _mm_packs_epi32(hits[2], hits[3]));
  return static_cast<unsigned>(_mm_movemask_epi8(packed));
}

#include "simd/compare_entries_sse2.inl"

inline void streamStore(float* to, Vector value) { _mm_stream_ps(to, value); }
inline Vector loadUnaligned(const float* from) { return _mm_loadu_ps(from); }

inline unsigned valuesWithin(const std::uint64_t* line, std::uint64_t limits) {
  const __m128i limit = _mm_set1_epi64x(static_cast<std::int64_t>(limits));
  const auto* const pairs = reinterpret_cast<const __m128i*>(line);
  unsigned within = 0;
  for (int pair = 0; pair < 3; ++pair) {
    const __m128i above = _mm_subs_epu8(_mm_load_si128(pairs + pair), limit);
    const __m128i halves = _mm_cmpeq_epi32(above, _mm_setzero_si128());
    const __m128i whole = _mm_and_si128(halves, _mm_shuffle_epi32(halves, 0xB1));
    within |= static_cast<unsigned>(_mm_movemask_pd(_mm_castsi128_pd(whole))) << 2 * pair;
  }
  return within;
}

#include "simd/lines_within.inl"
