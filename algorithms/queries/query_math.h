// The definition of hits and distances, in doubles: what queries compute for bodies, and for the
// nodes that enclose them. Every operation is monotone in the bounds of the box, also as rounded,
// so that a box is not missed if a box inside of it is hit.
#pragma once

namespace broadmark::broadphase {

/// Relative. The times at which a cast enters and leaves a box differ from the exact ones by less
/// than half of this each: three roundings, of 2^-53.
inline constexpr double kCastTolerance = 0x1p-50;
/// Above every time of every cast of floats, and every squared distance.
inline constexpr double kNoLimit = 0x1p300;

[[gnu::always_inline]] inline double smallerOf(double a, double b) { return a < b ? a : b; }
[[gnu::always_inline]] inline double largerOf(double a, double b) { return a > b ? a : b; }

/// One axis of a cast: when it is at a bound of a box, in units of the direction.
///
/// A direction of 0 is replaced by a very small one: a box ahead is reached after kNoLimit; one
/// that is touched has been reached at time 0, and is left after kNoLimit.
struct CastAxis {
  double near_origin;  ///< the side of the moving box that meets the near bound
  double far_origin;
  double inverse;  ///< of the direction
  bool backwards;  ///< the near bound is the box's max

  CastAxis() = default;
  CastAxis(float min, float max, float direction)
      : near_origin(direction < 0 ? min : max),
        far_origin(direction < 0 ? max : min),
        inverse(direction == 0 ? 0x1p600 : 1 / static_cast<double>(direction)),
        backwards(direction < 0) {
    if (direction != 0) return;
    const double size = min < 0 ? -far_origin : far_origin;
    far_origin -= largerOf(size * 0x1p-50, 0x1p-200);  // above the next lower float
  }

  /// Negative if it has passed the bound.
  [[gnu::always_inline]] double timeOfNear(float bound) const {
    return (static_cast<double>(bound) - near_origin) * inverse;
  }
  [[gnu::always_inline]] double timeOfFar(float bound) const {
    return (static_cast<double>(bound) - far_origin) * inverse;
  }
};

/// A cast enters a box at the latest `timeOfNear` of the axes, and at least 0. It hits if that is
/// neither after the earliest `timeOfFar`, with tolerance, nor after its limit.
inline double castLimit(float max_fraction) {
  return smallerOf(static_cast<double>(max_fraction) * (1 + kCastTolerance), kNoLimit);
}

/// Of distances.
inline double squaredLimit(float max_distance) {
  return smallerOf(static_cast<double>(max_distance) * static_cast<double>(max_distance), kNoLimit);
}
/// How far a point is from an interval.
[[gnu::always_inline]] inline double axisDistance(double point, float min, float max) {
  return largerOf(largerOf(static_cast<double>(min) - point, point - static_cast<double>(max)), 0);
}

}  // namespace broadmark::broadphase
