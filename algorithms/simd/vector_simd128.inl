// WebAssembly: four lanes. The functions are documented in vector_scalar.inl.

inline constexpr std::size_t kLanes = 4;
using Vector = float __attribute__((vector_size(16)));
using Mask = std::int32_t __attribute__((vector_size(16)));
using Keys = std::uint32_t __attribute__((vector_size(16)));

inline Vector load(const float* from) { return *reinterpret_cast<const Vector*>(from); }
inline Vector loadUnaligned(const float* from) { return Vector(wasm_v128_load(from)); }
inline Vector broadcast(float value) { return Vector(wasm_f32x4_splat(value)); }
inline Mask overlap(Vector a_min, Vector a_max, Vector b_min, Vector b_max) {
  return (a_min <= b_max) & (b_min <= a_max);
}
inline Mask overlap(Mask lanes, Vector a_min, Vector a_max, Vector b_min, Vector b_max) {
  return lanes & overlap(a_min, a_max, b_min, b_max);
}
inline Mask maskOr(Mask a, Mask b) { return a | b; }
inline unsigned bits(Mask mask) { return wasm_i32x4_bitmask(v128_t(mask)); }
inline bool none(Mask mask) { return !wasm_v128_any_true(v128_t(mask)); }

inline void loadCorners(const float* corners, Vector (&axes)[3]) {
  Vector rows[4];
  for (int r = 0; r < 4; ++r) rows[r] = loadUnaligned(corners + 8 * r);
  const Vector low = __builtin_shufflevector(rows[0], rows[1], 0, 4, 1, 5);   // x0 x1 y0 y1
  const Vector high = __builtin_shufflevector(rows[2], rows[3], 0, 4, 1, 5);  // x2 x3 y2 y3
  const Vector low_z = __builtin_shufflevector(rows[0], rows[1], 2, 6, 2, 6);
  const Vector high_z = __builtin_shufflevector(rows[2], rows[3], 2, 6, 2, 6);
  axes[0] = __builtin_shufflevector(low, high, 0, 1, 4, 5);
  axes[1] = __builtin_shufflevector(low, high, 2, 3, 6, 7);
  axes[2] = __builtin_shufflevector(low_z, high_z, 0, 1, 4, 5);
}
// The pseudo-minimum of (b, a) is a < b ? a : b.
inline Vector minOf(Vector a, Vector b) { return Vector(wasm_f32x4_pmin(v128_t(b), v128_t(a))); }
inline Vector maxOf(Vector a, Vector b) { return Vector(wasm_f32x4_pmax(v128_t(b), v128_t(a))); }
inline void storeTruncated(Vector value, std::uint32_t* to) {
  wasm_v128_store(to, wasm_i32x4_trunc_sat_f32x4(v128_t(value)));
}
inline void streamStore(float* to, Vector value) { *reinterpret_cast<Vector*>(to) = value; }

#include "simd/vector_common.inl"

inline unsigned equal(Keys a, Keys b) { return bits(a == b); }
inline unsigned positive(Keys numbers) { return bits(Mask(numbers) > 0); }

inline constexpr std::size_t kHitLanes = 4;
inline std::uint64_t hitsAtOffsets(const std::uint32_t* keys, Keys limits, Keys remaining) {
  v128_t hits[kHitOffsets];
  for (std::size_t offset = 0; offset < kHitOffsets; ++offset) {
    const v128_t above = wasm_u8x16_sub_sat(v128_t(loadKeys(keys + offset)), v128_t(limits));
    hits[offset] = v128_t((Keys(above) == 0) & (Mask(remaining) > static_cast<int>(offset)));
  }
  return wasm_i8x16_bitmask(wasm_i8x16_narrow_i16x8(wasm_i16x8_narrow_i32x4(hits[0], hits[1]),
                                                    wasm_i16x8_narrow_i32x4(hits[2], hits[3])));
}

struct EntryComparison {
  unsigned overlap;
  unsigned ambiguous;
};
inline EntryComparison compareEntries(const std::uint32_t* a, const std::uint32_t* b) {
  constexpr Mask kSweepAxis = {-1, -1, 0, 0};
  constexpr Mask kKey = {0, 0, -1, 0};
  const v128_t entry_b = wasm_v128_load(b);
  // Swaps the first two fields, and the halves of the third.
  const v128_t entry_a = wasm_v128_load(a);
  const v128_t limits = wasm_v128_not(wasm_i16x8_shuffle(entry_a, entry_a, 2, 3, 0, 1, 5, 4, 6, 7));
  const Mask apart = Mask(Keys(entry_b) > Keys(limits)) & kSweepAxis;
  const Mask equal_bounds = (Mask(Keys(entry_b) == Keys(limits)) & kSweepAxis) |
                            (Mask(wasm_i8x16_eq(entry_b, limits)) & kKey);
  return {none(apart) ? 1U : 0U, none(equal_bounds) ? 0U : 1U};
}

inline unsigned valuesWithin(const std::uint64_t* line, std::uint64_t limits) {
  const v128_t limit = wasm_i64x2_splat(static_cast<std::int64_t>(limits));
  unsigned within = 0;
  for (unsigned pair = 0; pair < 3; ++pair) {
    const v128_t above = wasm_u8x16_sub_sat(wasm_v128_load(line + 2 * pair), limit);
    within |= unsigned{wasm_i64x2_bitmask(wasm_i64x2_eq(above, wasm_i64x2_const_splat(0)))}
              << 2 * pair;
  }
  return within;
}

#include "simd/lines_within.inl"
