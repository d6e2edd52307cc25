// Four lanes. Functions as explained in vector_scalar.inl.

inline constexpr std::size_t kLanes = 4;
using Vector = float32x4_t;
using Mask = uint32x4_t;

inline Vector load(const float* from) { return vld1q_f32(from); }
inline Vector broadcast(float value) { return vdupq_n_f32(value); }
inline Mask meet(Vector a_min, Vector a_max, Vector b_min, Vector b_max) {
  return vandq_u32(vcleq_f32(a_min, b_max), vcleq_f32(b_min, a_max));
}
inline Mask meet(Mask of, Vector a_min, Vector a_max, Vector b_min, Vector b_max) {
  return vandq_u32(of, meet(a_min, a_max, b_min, b_max));
}
inline Mask either(Mask a, Mask b) { return vorrq_u32(a, b); }
inline unsigned bits(Mask mask) {
  constexpr Mask kLaneBits = {1, 2, 4, 8};
  return vaddvq_u32(vandq_u32(mask, kLaneBits));
}
inline bool none(Mask mask) { return vmaxvq_u32(mask) == 0; }
