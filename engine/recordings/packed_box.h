// Boxes as they lie in a recording 2: six floats, min x y z, max x y z. Unpacked and checked a
// corner at a time, which is a SIMD register; GCC and clang have this notation for any processor.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

#include "broadmark/aabb.h"

namespace broadmark {

using PackedBox = std::array<float, 6>;

inline PackedBox packed(const Aabb& box) {
  return {box.min[0], box.min[1], box.min[2], box.max[0], box.max[1], box.max[2]};
}

/// A box in registers.
class BoxCorners {
 public:
  /// Of a packed box.
  explicit BoxCorners(const std::byte* raw) {
    const Floats zero = {};
    Floats max;  // after the last component of min
    std::memcpy(&min_, raw, sizeof min_);
    std::memcpy(&max, raw + 2 * sizeof(float), sizeof max);
    min_ = __builtin_shufflevector(min_, zero, 0, 1, 2, 4);
    max_ = __builtin_shufflevector(max, zero, 1, 2, 3, 4);
  }

  void put(Aabb& box) const {
    std::memcpy(box.min.data(), &min_, sizeof min_);
    std::memcpy(box.max.data(), &max_, sizeof max_);
  }

  /// Whether it is this one, to the bit.
  [[nodiscard]] bool is(const Aabb& box) const {
    const auto min = std::bit_cast<Bits>(box.min) ^ std::bit_cast<Bits>(min_);
    const auto max = std::bit_cast<Bits>(box.max) ^ std::bit_cast<Bits>(max_);
    return !any(min | max);
  }

  /// Whether it is finite and not inverted or, where that may be, that of an absent body.
  [[nodiscard]] bool isRight(bool may_be_empty) const {
    constexpr float kHuge = std::numeric_limits<float>::max();
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    const Floats huge = {kHuge, kHuge, kHuge, kHuge};
    const Floats infinity = {kInfinity, kInfinity, kInfinity, 0};
    if (!any(~((min_ <= max_) & (min_ >= -huge) & (max_ <= huge)))) return true;
    return may_be_empty && !any((min_ != infinity) | (max_ != -infinity));
  }

 private:
  using Floats = float __attribute__((vector_size(16)));
  using Bits = std::int32_t __attribute__((vector_size(16)));

  static bool any(Bits bits) {
    const auto halves = std::bit_cast<std::array<std::uint64_t, 2>>(bits);
    return (halves[0] | halves[1]) != 0;
  }

  Floats min_;
  Floats max_;
};

}  // namespace broadmark
