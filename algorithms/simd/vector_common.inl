// What is spelled the same for vectors of any length and for one lane, in the notation that GCC and
// clang have for both. Included by each vector_*.inl.

/// From any address.
inline Keys loadKeys(const std::uint32_t* from) {
  using Unaligned [[gnu::aligned(4), gnu::may_alias]] = Keys;
  return *reinterpret_cast<const Unaligned*>(from);
}
inline Keys broadcastKey(std::uint32_t key) { return key - Keys{}; }
/// `position` and those behind it.
inline Keys lanesFrom(std::uint32_t position) {
  static constexpr std::uint32_t kNumbers[16] = {0, 1, 2,  3,  4,  5,  6,  7,
                                                 8, 9, 10, 11, 12, 13, 14, 15};
  return loadKeys(kNumbers) + position;
}
/// The limits that follow from keys: see columns/copies.h.
inline Keys limitsOf(Keys keys) { return ~(keys << 16 | keys >> 16); }

/// (value - low) * factor as whole numbers from 0 to `last`, to any address; NaN becomes 0.
inline void storeSteps(Vector value, float low, float factor, float last, std::uint32_t* to) {
  const Vector step = (value - broadcast(low)) * broadcast(factor);
  storeWhole(minOf(maxOf(step, Vector{}), broadcast(last)), to);
}

/// How many steps behind all lanes are tested at once.
inline constexpr std::size_t kHitSteps = 4;
