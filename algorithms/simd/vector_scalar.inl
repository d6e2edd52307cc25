// One lane: what a vector is without SIMD. Included by for_each_isa.inl.

inline constexpr std::size_t kLanes = 1;
using Vector = float;
using Mask = unsigned;

inline Vector load(const float* from) { return *from; }
inline Vector broadcast(float value) { return value; }
/// Lanes in which the closed intervals [a_min, a_max] and [b_min, b_max] meet.
inline Mask meet(Vector a_min, Vector a_max, Vector b_min, Vector b_max) {
  // The larger minimum against the smaller maximum: half the instructions of two comparisons.
  return (a_min < b_min ? b_min : a_min) <= (b_max < a_max ? b_max : a_max) ? 1 : 0;
}
/// Those of the lanes `of` in which the intervals meet.
inline Mask meet(Mask of, Vector a_min, Vector a_max, Vector b_min, Vector b_max) {
  return of & meet(a_min, a_max, b_min, b_max);
}
inline Mask either(Mask a, Mask b) { return a | b; }
/// Lane i is bit i.
inline unsigned bits(Mask mask) { return mask; }
inline bool none(Mask mask) { return mask == 0; }

/// Keys: 32 bits each, four bytes.
using Keys = std::uint32_t;
/// The lanes in which no byte of the key is above that of the limits; lane i is bit i.
inline unsigned withinLimits(Keys keys, Keys limits) {
  // Even and odd bytes apart, each in front of a bit from which it may borrow.
  constexpr Keys kBytes = 0x00FF'00FF;
  constexpr Keys kBorrow = 0x0100'0100;
  const Keys even = (kBorrow | (limits & kBytes)) - (keys & kBytes);
  const Keys odd = (kBorrow | (limits >> 8 & kBytes)) - (keys >> 8 & kBytes);
  return (even & odd & kBorrow) == kBorrow ? 1 : 0;
}

/// The coordinates of kLanes corners, eight floats apart, by axis.
inline void loadCorners(const float* corners, Vector (&axes)[3]) {
  for (int axis = 0; axis < 3; ++axis) axes[axis] = corners[axis];
}
/// Where they cannot be compared (NaN): b.
inline Vector minOf(Vector a, Vector b) { return a < b ? a : b; }
inline Vector maxOf(Vector a, Vector b) { return a > b ? a : b; }
/// Towards 0, to any address; all of them are in the range of an integer.
inline void storeWhole(Vector value, std::uint32_t* to) {
  *to = static_cast<std::uint32_t>(static_cast<std::int32_t>(value));
}

#include "simd/vector_common.inl"

/// The lanes in which they are equal; lane i is bit i.
inline unsigned equal(Keys a, Keys b) { return a == b ? 1 : 0; }
/// The lanes with a number above 0, signed.
inline unsigned positive(Keys numbers) { return static_cast<std::int32_t>(numbers) > 0 ? 1 : 0; }
/// How many lanes of a step are neighbours in the bits of hits: bit
/// (l / kHitLanes * kHitSteps + s) * kHitLanes + l % kHitLanes is lane l and step s.
inline constexpr std::size_t kHitLanes = 1;
/// The hits of four steps: in lane l and step s, keys[l + s] is within the limits, and s is below
/// what is left.
inline std::uint64_t hitsOfSteps(const std::uint32_t* keys, Keys limits, Keys left) {
  std::uint64_t hits = 0;
  for (std::size_t s = 0; s < kHitSteps; ++s) {
    hits |= std::uint64_t{withinLimits(keys[s], limits) & positive(left - static_cast<Keys>(s))}
            << s;
  }
  return hits;
}

/// Of two copies (columns/copies.h), four numbers each, aligned to 16 bytes: whether they overlap
/// on the sweep axis, in steps, and whether bounds on any axis share a step. 1 or 0 each.
struct ComparedCopies {
  unsigned overlap;
  unsigned shared;
};
inline ComparedCopies compareCopies(const std::uint32_t* a, const std::uint32_t* b) {
  const std::uint32_t a_last = ~a[1];
  const std::uint32_t b_last = ~b[1];
  // A byte of the key that is as high as the limit.
  const std::uint32_t below = limitsOf(a[2]) - b[2];  // byte by byte: none is borrowed from
  const bool in_key = ((below - 0x0101'0101) & ~below & 0x8080'8080) != 0;
  return {unsigned{a[0] <= b_last} & unsigned{b[0] <= a_last},
          unsigned{a[0] == b_last} | unsigned{b[0] == a_last} | unsigned{in_key}};
}

/// To an address aligned to a vector, past the caches if there is a way.
inline void storePastCaches(float* to, Vector value) { *to = value; }
/// From any address.
inline Vector loadFromAnywhere(const float* from) { return *from; }

/// Of the first five numbers in a cache line: bit i is set if no byte of number i is above that of
/// `limits`. All bytes are at most 127.
inline unsigned numbersWithin(const std::uint64_t* line, std::uint64_t limits) {
  constexpr std::uint64_t kHighest = 0x8080'8080'8080'8080;
  unsigned within = 0;
  for (unsigned i = 0; i < 5; ++i) {
    within |= unsigned{(((limits | kHighest) - line[i]) & kHighest) == kHighest} << i;
  }
  return within;
}

#include "simd/lines_within.inl"
