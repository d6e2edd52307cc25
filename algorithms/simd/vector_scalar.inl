// One lane: what a vector is without SIMD. Included by for_each_isa.inl.

inline constexpr std::size_t kLanes = 1;
using Vector = float;
using Mask = unsigned;

inline Vector load(const float* from) { return *from; }
inline Vector broadcast(float value) { return value; }
/// Lanes in which the closed intervals [a_min, a_max] and [b_min, b_max] meet.
inline Mask meet(Vector a_min, Vector a_max, Vector b_min, Vector b_max) {
  return static_cast<Mask>(a_min <= b_max) & static_cast<Mask>(b_min <= a_max);
}
inline Mask both(Mask a, Mask b) { return a & b; }
inline Mask either(Mask a, Mask b) { return a | b; }
/// Lane i is bit i.
inline unsigned bits(Mask mask) { return mask; }
