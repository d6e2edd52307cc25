// Vectors of eight numbers with the compiler's vector extension, and functions on them.

constexpr int kLanes = 8;
using Floats = float __attribute__((vector_size(4 * kLanes)));
using Ints = int __attribute__((vector_size(4 * kLanes)));

inline constexpr Floats kLaneNumbers = {0, 1, 2, 3, 4, 5, 6, 7};

inline Floats broadcast(float value) { return value - Floats{}; }

inline float smaller(float a, float b) { return a < b ? a : b; }
inline float larger(float a, float b) { return a > b ? a : b; }
inline Floats smaller(Floats a, Floats b) { return a < b ? a : b; }
inline Floats larger(Floats a, Floats b) { return a > b ? a : b; }
inline Floats clamped(Floats value, float low, float high) {
  return smaller(larger(value, broadcast(low)), broadcast(high));
}
inline Floats magnitude(Floats value) { return larger(value, -value); }
inline Floats mixed(Floats a, Floats b, Floats part) { return a + (b - a) * part; }

inline bool any(Ints mask) {
  using Longs = long long __attribute__((vector_size(4 * kLanes)));
  const Longs halves = reinterpret_cast<Longs>(mask);
  return ((halves[0] | halves[1]) | (halves[2] | halves[3])) != 0;
}

/// GLSL's smoothstep.
inline Floats smoothstep(Floats low, Floats high, Floats value) {
  const Floats t = clamped((value - low) / (high - low), 0, 1);
  return t * t * (3.0F - 2.0F * t);
}

/// Loads or stores eight values at an unaligned address.
template <class Vector>
inline Vector load(const void* from) {
  Vector vector;
  __builtin_memcpy(&vector, from, sizeof vector);
  return vector;
}
template <class Vector>
inline void store(void* to, Vector vector) {
  __builtin_memcpy(to, &vector, sizeof vector);
}

/// The vector of get(lane) for each lane.
template <class Get>
inline Floats gather(const Get& get) {
  return Floats{get(0), get(1), get(2), get(3), get(4), get(5), get(6), get(7)};
}

/// The item of a lane; lanes beyond `count` repeat the first item.
template <class Item>
inline const Item& itemOf(const Item* items, std::size_t count, int lane) {
  const auto offset = static_cast<std::size_t>(lane);
  return items[offset < count ? offset : 0];
}

/// The channel red, green or blue (0, 1, 2) of colours 0xRRGGBB, from 0 to 255.
inline Floats channelOf(Ints rgb, int channel) {
  return __builtin_convertvector((rgb >> (16 - 8 * channel)) & 0xFF, Floats);
}

/// Colours in memory order, mixed with the colours under them.
inline Ints blended(Ints under, Ints over, Floats alpha) {
  Ints rgba = static_cast<int>(0xFF000000U) - Ints{};
  for (int shift = 0; shift < 24; shift += 8) {
    const Floats from = __builtin_convertvector((under >> shift) & 0xFF, Floats);
    const Floats to = __builtin_convertvector((over >> shift) & 0xFF, Floats);
    rgba |= __builtin_convertvector(mixed(from, to, alpha) + 0.5F, Ints) << shift;
  }
  return rgba;
}

/// The depth in OpenGL's depth buffer, from 0 to 1.
inline Floats windowDepth(const SplatView& view, Floats depth) {
  const float range = view.far - view.near;
  return clamped(view.far / range - view.far * view.near / range / depth, 0, 1);
}

/// The first and the last covered pixel of `count`: pixels with a middle between `low` and `high`,
/// with a little slack for rounding.
struct Extent {
  Ints first;
  Ints last;
};
inline Extent pixelExtent(Floats low, Floats high, int count) {
  constexpr float kSlack = 0.02F;
  const auto limit = static_cast<float>(count);
  return {__builtin_convertvector(clamped(low - (0.5F + kSlack), -1, limit) + 1.0F, Ints),
          __builtin_convertvector(clamped(high - (0.5F - kSlack), -1, limit - 1) + 1.0F, Ints) - 1};
}

/// Stores the rectangles of two extents for the first `count` lanes.
inline void storeRectangles(const Extent& columns, const Extent& rows, Ints is_visible,
                            std::size_t count, PixelRectangle* rectangles) {
  for (std::size_t lane = 0; lane < count; ++lane) {
    PixelRectangle rectangle;
    if (is_visible[lane] != 0 && rows.first[lane] <= rows.last[lane]) {
      rectangle = {static_cast<std::int16_t>(columns.first[lane]),
                   static_cast<std::int16_t>(columns.last[lane]),
                   static_cast<std::int16_t>(rows.first[lane]),
                   static_cast<std::int16_t>(rows.last[lane])};
    }
    rectangles[lane] = rectangle;
  }
}

/// An item's rows in a band: [begin, end).
struct Rows {
  int begin;
  int end;
};
inline Rows rowsIn(const SplatBand& band, const PixelRectangle& rectangle) {
  return {rectangle.bottom > band.begin ? rectangle.bottom : band.begin,
          rectangle.top < band.end ? rectangle.top + 1 : band.end};
}
