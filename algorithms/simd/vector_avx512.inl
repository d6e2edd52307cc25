// Sixteen lanes. Functions as explained in vector_scalar.inl.

inline constexpr std::size_t kLanes = 16;
using Vector = __m512;
using Mask = __mmask16;

inline Vector load(const float* from) { return _mm512_load_ps(from); }
inline Vector broadcast(float value) { return _mm512_set1_ps(value); }
// Compares into mask registers run on one port only, min and max on two. So the first axis is
// tested by two comparisons and the others by the larger minimum against the smaller maximum, which
// is the same for any two boxes with min <= max, and false for the padding: that keeps both ports
// busy.
inline Mask meet(Vector a_min, Vector a_max, Vector b_min, Vector b_max) {
  return _mm512_mask_cmp_ps_mask(_mm512_cmp_ps_mask(a_min, b_max, _CMP_LE_OQ), b_min, a_max,
                                 _CMP_LE_OQ);
}
inline Mask meet(Mask of, Vector a_min, Vector a_max, Vector b_min, Vector b_max) {
  return _mm512_mask_cmp_ps_mask(of, _mm512_max_ps(a_min, b_min), _mm512_min_ps(a_max, b_max),
                                 _CMP_LE_OQ);
}
// As mask registers: left to itself, GCC moves each mask to a general one first.
inline Mask either(Mask a, Mask b) { return _mm512_kor(a, b); }
inline unsigned bits(Mask mask) { return mask; }
inline bool none(Mask mask) { return _mm512_kortestz(mask, mask) != 0; }
