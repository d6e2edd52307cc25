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
