// Axis-aligned bounding boxes, and the definition of overlap.
//
// Example:
//
//   const Aabb a{{0, 0, 0}, {1, 1, 1}};
//   const Aabb b{{1, 0, 0}, {2, 1, 1}};
//   const bool touching = overlaps(a, b);                // true: touching counts
//   const Aabb both = merged(a, b);                      // (0, 0, 0) to (2, 1, 1)
//   const bool absent = overlaps(kEmptyBox, kEmptyBox);  // false: no body is there
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace broadmark {

/// An axis-aligned box in world units, laid out as in an .aabbs recording: 32 bytes, the fourth
/// component of each corner is padding (0). All bounds are finite and in order on every axis,
/// unless it is kEmptyBox.
struct alignas(16) Aabb {
  std::array<float, 4> min{};
  std::array<float, 4> max{};

  friend bool operator==(const Aabb&, const Aabb&) = default;
};
static_assert(sizeof(Aabb) == 32);

/// Bitwise equality: unlike ==, distinguishes -0 from 0, so that recordings round-trip exactly.
constexpr bool sameBits(const Aabb& a, const Aabb& b) {
  using Bits = std::array<std::uint64_t, 4>;
  return std::bit_cast<Bits>(a) == std::bit_cast<Bits>(b);
}

/// Closed intersection on all three axes, in 32-bit floats: touching counts.
constexpr bool overlaps(const Aabb& a, const Aabb& b) {
  // `&`, not `&&`: six cheap comparisons beat a mispredicted branch.
  const auto in_order = [](float low, float high) -> int { return low <= high; };
  return (in_order(a.min[0], b.max[0]) & in_order(b.min[0], a.max[0]) &
          in_order(a.min[1], b.max[1]) & in_order(b.min[1], a.max[1]) &
          in_order(a.min[2], b.max[2]) & in_order(b.min[2], a.max[2])) != 0;
}

/// The box of a body that is absent: it overlaps nothing, itself included.
inline constexpr Aabb kEmptyBox = [] {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  return Aabb{{kInfinity, kInfinity, kInfinity, 0}, {-kInfinity, -kInfinity, -kInfinity, 0}};
}();

/// Whether the body is absent. Tests the first axis alone: an absent body's box is kEmptyBox.
constexpr bool isEmpty(const Aabb& box) { return box.min[0] > box.max[0]; }

/// The middle of the box along an axis, 0 to 2; NaN for an absent body. In double: the sum of two
/// huge coordinates may overflow a float.
constexpr double centreOf(const Aabb& box, std::size_t axis) {
  return (static_cast<double>(box.min[axis]) + static_cast<double>(box.max[axis])) / 2;
}

/// The longest extent along an axis. In double, for the same reason; 0 for an absent body.
constexpr double longestEdge(const Aabb& box) {
  double longest = 0;
  for (int axis = 0; axis < 3; ++axis) {
    longest = std::max(longest, double{box.max[axis]} - double{box.min[axis]});
  }
  return longest;
}

/// Whether the centre of `box` lies in `outer`, faces included; false for an absent body.
constexpr bool holdsCentre(const Aabb& outer, const Aabb& box) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double centre = centreOf(box, axis);
    if (!(centre >= outer.min[axis] && centre <= outer.max[axis])) return false;
  }
  return true;
}

/// Whether `inner` lies within `outer`, faces included. Every box contains kEmptyBox.
constexpr bool contains(const Aabb& outer, const Aabb& inner) {
  for (int axis = 0; axis < 3; ++axis) {
    if (inner.min[axis] < outer.min[axis] || inner.max[axis] > outer.max[axis]) return false;
  }
  return true;
}

/// The box grown by `margin` on every side; bounds are rounded to the nearest float, not outward.
constexpr Aabb enlarged(Aabb box, float margin) {
  for (int axis = 0; axis < 3; ++axis) {
    box.min[axis] -= margin;
    box.max[axis] += margin;
  }
  return box;
}

/// The smallest box that contains both; merging with kEmptyBox changes nothing.
constexpr Aabb merged(const Aabb& a, const Aabb& b) {
  Aabb box;
  for (int axis = 0; axis < 3; ++axis) {
    box.min[axis] = std::min(a.min[axis], b.min[axis]);
    box.max[axis] = std::max(a.max[axis], b.max[axis]);
  }
  return box;
}

}  // namespace broadmark
