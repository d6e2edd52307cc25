// Sixteen lanes. Functions as explained in vector_scalar.inl.

inline constexpr std::size_t kLanes = 16;
using Vector = __m512;
using Mask = __mmask16;

inline Vector load(const float* from) { return _mm512_load_ps(from); }
inline Vector broadcast(float value) { return _mm512_set1_ps(value); }
inline Mask meet(Vector a_min, Vector a_max, Vector b_min, Vector b_max) {
  // The same for any two boxes with min <= max, and false for the padding. Compares into mask
  // registers run on one port only, min and max on two.
  return _mm512_cmp_ps_mask(_mm512_max_ps(a_min, b_min), _mm512_min_ps(a_max, b_max), _CMP_LE_OQ);
}
inline Mask both(Mask a, Mask b) { return static_cast<Mask>(a & b); }
inline Mask either(Mask a, Mask b) { return static_cast<Mask>(a | b); }
inline unsigned bits(Mask mask) { return mask; }
