// Four lanes. Functions as explained in vector_scalar.inl.

inline constexpr std::size_t kLanes = 4;
using Vector = __m128;
using Mask = __m128;

inline Vector load(const float* from) { return _mm_load_ps(from); }
inline Vector broadcast(float value) { return _mm_set1_ps(value); }
inline Mask meet(Vector a_min, Vector a_max, Vector b_min, Vector b_max) {
  return _mm_and_ps(_mm_cmple_ps(a_min, b_max), _mm_cmple_ps(b_min, a_max));
}
inline Mask meet(Mask of, Vector a_min, Vector a_max, Vector b_min, Vector b_max) {
  return _mm_and_ps(of, meet(a_min, a_max, b_min, b_max));
}
inline Mask either(Mask a, Mask b) { return _mm_or_ps(a, b); }
inline unsigned bits(Mask mask) { return static_cast<unsigned>(_mm_movemask_ps(mask)); }
inline bool none(Mask mask) { return bits(mask) == 0; }
