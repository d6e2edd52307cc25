// Functions that read the same for scalars and GCC/clang vector types. Included by each
// vector_*.inl.

/// From any address.
inline Keys loadKeys(const std::uint32_t* from) {
  using Unaligned [[gnu::aligned(4), gnu::may_alias]] = Keys;
  return *reinterpret_cast<const Unaligned*>(from);
}
inline Keys broadcastKey(std::uint32_t key) { return key - Keys{}; }
/// first, first + 1, ...
inline Keys iotaFrom(std::uint32_t first) {
  static constexpr std::uint32_t kNumbers[16] = {0, 1, 2,  3,  4,  5,  6,  7,
                                                 8, 9, 10, 11, 12, 13, 14, 15};
  return loadKeys(kNumbers) + first;
}
/// The limits of keys: see columns/cell_entries.h.
inline Keys limitsOf(Keys keys) { return ~(keys << 16 | keys >> 16); }

/// Stores (value - origin) * scale, clamped to [0, max] and truncated, to any address; NaN becomes
/// 0.
inline void storeQuantized(Vector value, float origin, float scale, float max, std::uint32_t* to) {
  const Vector scaled = (value - broadcast(origin)) * broadcast(scale);
  storeTruncated(minOf(maxOf(scaled, Vector{}), broadcast(max)), to);
}

/// How many offsets hitsAtOffsets() tests.
inline constexpr std::size_t kHitOffsets = 4;
