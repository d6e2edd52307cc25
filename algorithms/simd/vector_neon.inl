// Four lanes. The functions are documented in vector_scalar.inl.

inline constexpr std::size_t kLanes = 4;
using Vector = float32x4_t;
using Mask = uint32x4_t;

inline Vector load(const float* from) { return vld1q_f32(from); }
inline Vector broadcast(float value) { return vdupq_n_f32(value); }
inline Mask overlap(Vector a_min, Vector a_max, Vector b_min, Vector b_max) {
  return vandq_u32(vcleq_f32(a_min, b_max), vcleq_f32(b_min, a_max));
}
inline Mask overlap(Mask lanes, Vector a_min, Vector a_max, Vector b_min, Vector b_max) {
  return vandq_u32(lanes, overlap(a_min, a_max, b_min, b_max));
}
inline Mask maskOr(Mask a, Mask b) { return vorrq_u32(a, b); }
inline unsigned bits(Mask mask) {
  constexpr Mask kLaneBits = {1, 2, 4, 8};
  return vaddvq_u32(vandq_u32(mask, kLaneBits));
}
inline bool none(Mask mask) { return vmaxvq_u32(mask) == 0; }

using Keys = uint32x4_t;
inline unsigned withinLimits(Keys keys, Keys limits) {
  const Keys above =
      vreinterpretq_u32_u8(vqsubq_u8(vreinterpretq_u8_u32(keys), vreinterpretq_u8_u32(limits)));
  return bits(vceqzq_u32(above));
}

inline void loadCorners(const float* corners, Vector (&axes)[3]) {
  Vector rows[4];
  for (int r = 0; r < 4; ++r) rows[r] = vld1q_f32(corners + 8 * r);
  const float32x4x2_t low = vzipq_f32(rows[0], rows[2]);   // x0 x2 y0 y2, z0 z2 ..
  const float32x4x2_t high = vzipq_f32(rows[1], rows[3]);  // x1 x3 y1 y3, z1 z3 ..
  const float32x4x2_t both = vzipq_f32(low.val[0], high.val[0]);
  axes[0] = both.val[0];
  axes[1] = both.val[1];
  axes[2] = vzipq_f32(low.val[1], high.val[1]).val[0];
}
inline Vector minOf(Vector a, Vector b) { return vminq_f32(a, b); }
inline Vector maxOf(Vector a, Vector b) { return vmaxnmq_f32(a, b); }
inline void storeTruncated(Vector value, std::uint32_t* to) { vst1q_u32(to, vcvtq_u32_f32(value)); }

#include "simd/vector_common.inl"

inline unsigned equal(Keys a, Keys b) { return bits(vceqq_u32(a, b)); }
inline unsigned positive(Keys numbers) { return bits(vcgtzq_s32(vreinterpretq_s32_u32(numbers))); }

inline constexpr std::size_t kHitLanes = 4;
inline std::uint64_t hitsAtOffsets(const std::uint32_t* keys, Keys limits, Keys remaining) {
  std::uint64_t hits = 0;
  for (std::size_t offset = 0; offset < kHitOffsets; ++offset) {
    const unsigned in_window = positive(remaining - static_cast<std::uint32_t>(offset));
    hits |= std::uint64_t{withinLimits(vld1q_u32(keys + offset), limits) & in_window}
            << (offset * kHitLanes);
  }
  return hits;
}

struct EntryComparison {
  unsigned overlap;
  unsigned ambiguous;
};
inline EntryComparison compareEntries(const std::uint32_t* a, const std::uint32_t* b) {
  constexpr Keys kSweepAxis = {~0U, ~0U, 0, 0};
  constexpr Keys kKey = {0, 0, ~0U, 0};
  const Keys entry_a = vld1q_u32(a);
  const Keys entry_b = vld1q_u32(b);
  // Swaps the first two fields, and the halves of the third.
  const Keys halves = vreinterpretq_u32_u16(vrev32q_u16(vreinterpretq_u16_u32(entry_a)));
  const Keys limits = vmvnq_u32(vbslq_u32(kSweepAxis, vrev64q_u32(entry_a), halves));
  const Keys apart = vandq_u32(vcgtq_u32(entry_b, limits), kSweepAxis);
  const Keys equal_bytes =
      vreinterpretq_u32_u8(vceqq_u8(vreinterpretq_u8_u32(entry_b), vreinterpretq_u8_u32(limits)));
  const Keys equal_bounds =
      vorrq_u32(vandq_u32(vceqq_u32(entry_b, limits), kSweepAxis), vandq_u32(equal_bytes, kKey));
  return {vmaxvq_u32(apart) == 0 ? 1U : 0U, vmaxvq_u32(equal_bounds) != 0 ? 1U : 0U};
}

inline void streamStore(float* to, Vector value) { vst1q_f32(to, value); }
inline Vector loadUnaligned(const float* from) { return vld1q_f32(from); }

inline unsigned valuesWithin(const std::uint64_t* line, std::uint64_t limits) {
  const uint8x16_t limit = vreinterpretq_u8_u64(vdupq_n_u64(limits));
  unsigned within = 0;
  for (unsigned pair = 0; pair < 3; ++pair) {
    const uint8x16_t above = vqsubq_u8(vreinterpretq_u8_u64(vld1q_u64(line + 2 * pair)), limit);
    const uint64x2_t none = vceqzq_u64(vreinterpretq_u64_u8(above));
    within |= (static_cast<unsigned>(vgetq_lane_u64(none, 0) & 1) |
               static_cast<unsigned>(vgetq_lane_u64(none, 1) & 2))
              << 2 * pair;
  }
  return within;
}

#include "simd/lines_within.inl"
