// Variance of box centres, for the choice of axes.
#pragma once

#include <algorithm>
#include <array>

#include "broadmark/aabb.h"

namespace broadmark {

/// A permutation of the three axes, the preferred axis first.
using AxisOrder = std::array<int, 3>;

/// Sums over box centres, in double, where the square of any float is finite. They are relative to
/// the centre of some box, as rounding would exceed the variance far from the origin.
struct Moments {
  std::array<double, 3> sum{};
  std::array<double, 3> sum_of_squares{};

  void add(const Aabb& box, const std::array<double, 3>& origin) {
    for (int axis = 0; axis < 3; ++axis) {
      const double distance = centreOf(box, axis) - origin[axis];
      sum[axis] += distance;
      sum_of_squares[axis] += distance * distance;
    }
  }
  void add(const Moments& other) {
    for (int axis = 0; axis < 3; ++axis) {
      sum[axis] += other.sum[axis];
      sum_of_squares[axis] += other.sum_of_squares[axis];
    }
  }
  [[nodiscard]] double variance(int axis, double count) const {
    return sum_of_squares[axis] / count - (sum[axis] / count) * (sum[axis] / count);
  }
  /// The axes by decreasing variance.
  [[nodiscard]] AxisOrder axes(double count) const {
    AxisOrder axes = {0, 1, 2};
    std::ranges::sort(axes, [&](int a, int b) {
      const double variance_a = variance(a, count);
      const double variance_b = variance(b, count);
      return variance_a != variance_b ? variance_a > variance_b : a < b;
    });
    return axes;
  }

  static std::array<double, 3> centre(const Aabb& box) {
    return {centreOf(box, 0), centreOf(box, 1), centreOf(box, 2)};
  }
};

}  // namespace broadmark
