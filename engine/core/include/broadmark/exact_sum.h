// Sums as floats that are rounded in a given direction: bounds of boxes that must contain others.
#pragma once

#include <cmath>
#include <limits>

namespace broadmark {

/// The sum of two finite numbers, and its rounding error: D. E. Knuth, TAOCP 2, 4.2.2, theorem B.
struct ExactSum {
  ExactSum(double a, double b) : value(a + b) {
    const double part = value - a;
    error = (a - (value - part)) + (b - part);
  }

  double value;
  double error;
};

/// The largest float that is not above a sum; -infinity if that is below the range of floats.
inline float floatBelow(const ExactSum& sum) {
  const auto nearest = static_cast<float>(sum.value);
  const bool is_above = nearest > sum.value || (nearest == sum.value && sum.error < 0);
  return is_above ? std::nextafter(nearest, -std::numeric_limits<float>::max()) : nearest;
}
/// The smallest float that is not below a sum; infinity if that is above the range of floats.
inline float floatAbove(const ExactSum& sum) {
  const auto nearest = static_cast<float>(sum.value);
  const bool is_below = nearest < sum.value || (nearest == sum.value && sum.error > 0);
  return is_below ? std::nextafter(nearest, std::numeric_limits<float>::max()) : nearest;
}

}  // namespace broadmark
