// Mean and variance of box centres, by which algorithms choose their axes.
#pragma once

#include <algorithm>
#include <array>

#include "broadmark/aabb.h"

namespace broadmark {

/// The three axes, in some order of preference.
using AxisOrder = std::array<int, 3>;

/// Sums over box centres, in double: the square of any float is finite there. They are relative to
/// some box's centre: far from the origin rounding would otherwise exceed the variance.
struct Moments {
  std::array<double, 3> sum{};
  std::array<double, 3> squares{};

  void add(const Aabb& box, const std::array<double, 3>& origin) {
    for (int axis = 0; axis < 3; ++axis) {
      const double distance = centreOf(box, axis) - origin[axis];
      sum[axis] += distance;
      squares[axis] += distance * distance;
    }
  }
  void add(const Moments& other) {
    for (int axis = 0; axis < 3; ++axis) {
      sum[axis] += other.sum[axis];
      squares[axis] += other.squares[axis];
    }
  }
  [[nodiscard]] double variance(int axis, double count) const {
    return squares[axis] / count - (sum[axis] / count) * (sum[axis] / count);
  }
  /// The axes by falling variance.
  [[nodiscard]] AxisOrder axes(double count) const {
    AxisOrder axes = {0, 1, 2};
    std::ranges::sort(axes, [&](int a, int b) {
      const double of_a = variance(a, count);
      const double of_b = variance(b, count);
      return of_a != of_b ? of_a > of_b : a < b;
    });
    return axes;
  }

  static std::array<double, 3> centre(const Aabb& box) {
    return {centreOf(box, 0), centreOf(box, 1), centreOf(box, 2)};
  }
};

}  // namespace broadmark
