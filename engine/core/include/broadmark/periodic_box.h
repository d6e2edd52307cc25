// Periodic worlds: whatever leaves through one face of a box enters through the opposite one.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "broadmark/aabb.h"

namespace broadmark {

/// The box of a periodic world, in world units. By default the world is not periodic.
struct PeriodicBox {
  std::array<double, 3> min{};
  std::array<double, 3> max{};

  /// Whether the world repeats along the axis.
  [[nodiscard]] bool repeats(int axis) const { return min[axis] < max[axis]; }
  [[nodiscard]] bool repeats() const { return repeats(0) || repeats(1) || repeats(2); }
  [[nodiscard]] double period(int axis) const { return max[axis] - min[axis]; }

  friend bool operator==(const PeriodicBox&, const PeriodicBox&) = default;
};

/// "0:10,-5:5,-": the bounds along each axis; "-": not periodic along it.
std::string periodicText(const PeriodicBox&);
/// The box of such a text. Throws InputError.
PeriodicBox parsePeriodic(std::string_view text);

/// The image of a box with its lower corner within the periodic box, rounded outward; kEmptyBox if
/// absent. Throws InputError for a box more than a million periods away.
Aabb wrapped(const Aabb&, const PeriodicBox&);

// A wrapped box may protrude from the periodic box at its upper faces. Its images are the box
// itself, and the boxes one period lower along some of the axes along which it protrudes. Two
// bodies overlap if any of their images do. `axes`: bit k is set for axis k.

/// The axes along which a wrapped box protrudes, or touches the upper face.
unsigned protrudingAxes(const Aabb& box, const PeriodicBox&);

/// The image one period lower along these axes, rounded outward.
Aabb image(Aabb box, unsigned axes, const PeriodicBox&);

/// The images of two wrapped boxes that are nearest to each other, along each axis. If any images
/// overlap, these do. Without a periodic world, the boxes themselves.
std::array<Aabb, 2> nearestImages(const Aabb& a, const Aabb& b, const PeriodicBox&);

/// Whether images of two wrapped boxes overlap; with a margin, once enlarged by it.
inline bool overlaps(const Aabb& a, const Aabb& b, const PeriodicBox& periodic, float margin = 0) {
  const auto [near_a, near_b] = nearestImages(a, b, periodic);
  return overlaps(enlarged(near_a, margin), enlarged(near_b, margin));
}

}  // namespace broadmark
