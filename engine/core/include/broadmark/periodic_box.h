// Periodic worlds: whatever leaves through one face of a box enters through the opposite one.
//
// Example:
//
//   const PeriodicBox periodic = parsePeriodic("0:10,0:10,-");
//   const Aabb a = wrapped({{-1, 4, 0}, {1, 6, 1}}, periodic);      // from x = 9 to 11
//   const Aabb b = wrapped({{0.5, 5, 0}, {1.5, 7, 1}}, periodic);   // as it is
//   const bool is_pair = overlaps(a, b, periodic);                  // true: across the face
//   const auto [near_a, near_b] = nearestImages(a, b, periodic);    // a from x = -1 to 1
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "broadmark/aabb.h"

namespace broadmark {

/// The box of a periodic world, in world units. By default the world is not periodic. Along an axis
/// that is not, both bounds are 0.
struct PeriodicBox {
  std::array<double, 3> min{};  ///< by axis
  std::array<double, 3> max{};

  /// Whether the world repeats along the axis, 0 to 2.
  [[nodiscard]] bool repeats(int axis) const { return min[axis] < max[axis]; }
  /// Whether it repeats along any axis.
  [[nodiscard]] bool repeats() const { return repeats(0) || repeats(1) || repeats(2); }
  /// The distance between two images along the axis, in world units; 0 if it does not repeat.
  [[nodiscard]] double period(int axis) const { return max[axis] - min[axis]; }

  friend bool operator==(const PeriodicBox&, const PeriodicBox&) = default;
};

/// "0:10,-5:5,-": the bounds along each axis; "-": not periodic along it.
std::string periodicText(const PeriodicBox&);
/// The box of such a text. Throws InputError, also for "-,-,-": some axis must repeat. Bounds are
/// within the range of floats.
PeriodicBox parsePeriodic(std::string_view text);

/// The image of a box with its lower corner within the periodic box, rounded outward; kEmptyBox if
/// absent. Axes that do not repeat are unchanged. Throws InputError for a box more than a million
/// periods away; the message begins with "its box", for the caller to name the body.
Aabb wrapped(const Aabb&, const PeriodicBox&);

// A wrapped box may protrude from the periodic box at its upper faces. Its images are the box
// itself, and the boxes one period lower along some of the axes along which it protrudes. Two
// bodies overlap if any of their images do. `axes`: bit k is set for axis k.

/// The axes along which a wrapped box protrudes, or touches the upper face, within a 10^-9th of the
/// period; none for an absent body.
unsigned protrudingAxes(const Aabb& box, const PeriodicBox&);

/// The image one period lower along these axes, rounded outward.
Aabb image(Aabb box, unsigned axes, const PeriodicBox&);

/// The images of two wrapped boxes that are nearest to each other, along each axis. If any images
/// overlap, these do. Without a periodic world, the boxes themselves, which need not be wrapped.
std::array<Aabb, 2> nearestImages(const Aabb& a, const Aabb& b, const PeriodicBox&);

/// Whether images of two wrapped boxes overlap; with a margin, once both are enlarged by it.
inline bool overlaps(const Aabb& a, const Aabb& b, const PeriodicBox& periodic, float margin = 0) {
  const auto [near_a, near_b] = nearestImages(a, b, periodic);
  return overlaps(enlarged(near_a, margin), enlarged(near_b, margin));
}

}  // namespace broadmark
