// One lane, without SIMD. Included by for_each_isa.inl, as are its counterparts for each
// instruction set.

inline constexpr std::size_t kLanes = 1;
using Vector = float;
using Mask = unsigned;

inline Vector load(const float* from) { return *from; }
inline Vector broadcast(float value) { return value; }
/// Lanes in which the closed intervals [a_min, a_max] and [b_min, b_max] overlap.
inline Mask overlap(Vector a_min, Vector a_max, Vector b_min, Vector b_max) {
  // The larger minimum against the smaller maximum: half the instructions of two comparisons.
  return (a_min < b_min ? b_min : a_min) <= (b_max < a_max ? b_max : a_max) ? 1 : 0;
}
/// The same, restricted to `lanes`.
inline Mask overlap(Mask lanes, Vector a_min, Vector a_max, Vector b_min, Vector b_max) {
  return lanes & overlap(a_min, a_max, b_min, b_max);
}
inline Mask maskOr(Mask a, Mask b) { return a | b; }
/// Lane i is bit i.
inline unsigned bits(Mask mask) { return mask; }
inline bool none(Mask mask) { return mask == 0; }

/// Keys of four bytes.
using Keys = std::uint32_t;
/// The lanes in which no byte of the key exceeds that of the limits; lane i is bit i.
inline unsigned withinLimits(Keys keys, Keys limits) {
  // Even and odd bytes are subtracted separately, each with a guard bit above it that is borrowed
  // from if the key exceeds the limit.
  constexpr Keys kBytes = 0x00FF'00FF;
  constexpr Keys kGuard = 0x0100'0100;
  const Keys even = (kGuard | (limits & kBytes)) - (keys & kBytes);
  const Keys odd = (kGuard | (limits >> 8 & kBytes)) - (keys >> 8 & kBytes);
  return (even & odd & kGuard) == kGuard ? 1 : 0;
}

/// Transposes kLanes corners, eight floats apart, into a vector per axis.
inline void loadCorners(const float* corners, Vector (&axes)[3]) {
  for (int axis = 0; axis < 3; ++axis) axes[axis] = corners[axis];
}
/// Returns b if either operand is NaN.
inline Vector minOf(Vector a, Vector b) { return a < b ? a : b; }
inline Vector maxOf(Vector a, Vector b) { return a > b ? a : b; }
/// Stores to any address; the truncated values fit into an int.
inline void storeTruncated(Vector value, std::uint32_t* to) {
  *to = static_cast<std::uint32_t>(static_cast<std::int32_t>(value));
}

#include "simd/vector_common.inl"

/// Lanes of equal keys; lane i is bit i.
inline unsigned equal(Keys a, Keys b) { return a == b ? 1 : 0; }
/// Lanes above 0, signed; lane i is bit i.
inline unsigned positive(Keys numbers) { return static_cast<std::int32_t>(numbers) > 0 ? 1 : 0; }
/// Lanes per group in the result of hitsAtOffsets(): lane l at offset o is bit
/// (l / kHitLanes * kHitOffsets + o) * kHitLanes + l % kHitLanes.
inline constexpr std::size_t kHitLanes = 1;
/// Lane l hits at offset o if keys[l + o] is within the limits of lane l and o < remaining.
inline std::uint64_t hitsAtOffsets(const std::uint32_t* keys, Keys limits, Keys remaining) {
  std::uint64_t hits = 0;
  for (std::size_t offset = 0; offset < kHitOffsets; ++offset) {
    const unsigned in_window = positive(remaining - static_cast<Keys>(offset));
    hits |= std::uint64_t{withinLimits(keys[offset], limits) & in_window} << offset;
  }
  return hits;
}

/// Compares two entries (columns::CellEntry), aligned to 16 bytes: whether their quantised bounds
/// overlap on the sweep axis, and whether bounds are equal on any axis. Each is 0 or 1.
struct EntryComparison {
  unsigned overlap;
  unsigned ambiguous;
};
inline EntryComparison compareEntries(const std::uint32_t* a, const std::uint32_t* b) {
  const std::uint32_t a_max = ~a[1];
  const std::uint32_t b_max = ~b[1];
  // A byte of the key equals its limit if their difference has a zero byte. No byte borrows, as the
  // keys are known to overlap.
  const std::uint32_t difference = limitsOf(a[2]) - b[2];
  const bool zero_byte = ((difference - 0x0101'0101) & ~difference & 0x8080'8080) != 0;
  return {unsigned{a[0] <= b_max} & unsigned{b[0] <= a_max},
          unsigned{a[0] == b_max} | unsigned{b[0] == a_max} | unsigned{zero_byte}};
}

/// A non-temporal store, where there is one, to an address aligned to a vector.
inline void streamStore(float* to, Vector value) { *to = value; }
inline Vector loadUnaligned(const float* from) { return *from; }

/// Bit i is set if no byte of value i exceeds that of the limits, for the first five values of a
/// cache line. All bytes are at most 127.
inline unsigned valuesWithin(const std::uint64_t* line, std::uint64_t limits) {
  constexpr std::uint64_t kTopBits = 0x8080'8080'8080'8080;
  unsigned within = 0;
  for (unsigned i = 0; i < 5; ++i) {
    within |= unsigned{(((limits | kTopBits) - line[i]) & kTopBits) == kTopBits} << i;
  }
  return within;
}

#include "simd/lines_within.inl"
