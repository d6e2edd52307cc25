// The caller's boxes, which are read, checked and enlarged.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>

#include "broadmark/aabb.h"
#include "broadmark/exact_sum.h"

namespace broadmark::broadphase {

/// Reads the caller's boxes, which need not be aligned.
class BoxReader {
 public:
  BoxReader(const void* min, const void* max, std::size_t stride, float margin)
      : min_(static_cast<const std::byte*>(min)),
        max_(static_cast<const std::byte*>(max)),
        stride_(stride),
        margin_(margin) {}

  /// As given.
  [[nodiscard]] Aabb raw(std::size_t body) const {
    Aabb box;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      box.min[axis] = load<float>(min_, body, axis);
      box.max[axis] = load<float>(max_, body, axis);
    }
    return box;
  }

  /// Whether the box is stored otherwise.
  [[nodiscard]] bool differs(std::size_t body, const Aabb& stored) const {
    if (margin_ != 0) return !sameBits(enlarged(body), stored);
    return differs(min_, body, stored.min) || differs(max_, body, stored.max);
  }

  void store(std::size_t body, Aabb& into) const {
    if (margin_ != 0) {
      into = enlarged(body);
      return;
    }
    store(min_, body, into.min);
    store(max_, body, into.max);
  }

 private:
  using Corner = std::array<float, 4>;

  template <class T>
  [[nodiscard]] T load(const std::byte* corners, std::size_t body, std::size_t axis) const {
    T value;
    std::memcpy(&value, corners + body * stride_ + axis * sizeof(float), sizeof(T));
    return value;
  }

  // Two coordinates at once. Both never read what was written in other pieces, for which a
  // processor would have to wait.
  [[nodiscard]] bool differs(const std::byte* corners, std::size_t body,
                             const Corner& stored) const {
    std::uint64_t xy;
    std::uint32_t z;
    std::memcpy(&xy, stored.data(), sizeof(xy));
    std::memcpy(&z, stored.data() + 2, sizeof(z));
    return ((xy ^ load<std::uint64_t>(corners, body, 0)) |
            (z ^ load<std::uint32_t>(corners, body, 2))) != 0;
  }
  void store(const std::byte* corners, std::size_t body, Corner& into) const {
    const auto xy = load<std::uint64_t>(corners, body, 0);
    const auto z = load<std::uint32_t>(corners, body, 2);
    std::memcpy(into.data(), &xy, sizeof(xy));
    std::memcpy(into.data() + 2, &z, sizeof(z));
  }

  [[nodiscard]] Aabb enlarged(std::size_t body) const {
    Aabb box = raw(body);
    constexpr float kMax = std::numeric_limits<float>::max();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      float& min = box.min[axis];
      float& max = box.max[axis];
      if (std::isfinite(min)) min = std::max(floatBelow({min, -margin_}), -kMax);
      if (std::isfinite(max)) max = std::min(floatAbove({max, margin_}), kMax);
    }
    return box;
  }

  const std::byte* min_;
  const std::byte* max_;
  std::size_t stride_;
  float margin_;
};

/// Whether a box is finite and not reversed.
inline bool isFiniteBox(const Aabb& box) {
  bool valid = true;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    // False for NaN, too. Branchless: compiles to vector instructions.
    valid &= (box.min[axis] <= box.max[axis]) &
             (box.min[axis] >= std::numeric_limits<float>::lowest()) &
             (box.max[axis] <= std::numeric_limits<float>::max());
  }
  return valid;
}

/// Whether a body may have the box.
inline bool isValid(const Aabb& box) {
  return isFiniteBox(box) || sameBits(box, broadmark::kEmptyBox);
}

/// Why a box is not finite, or reversed.
[[gnu::cold]] inline std::string faultOf(const Aabb& box) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string name(1, "xyz"[axis]);
    if (std::isnan(box.min[axis]) || std::isnan(box.max[axis])) return name + " is NaN";
    if (box.min[axis] <= box.max[axis] &&
        (std::isinf(box.min[axis]) || std::isinf(box.max[axis]))) {
      return name + " is infinite; the largest float is allowed";
    }
  }
  return "min > max";
}

}  // namespace broadmark::broadphase
