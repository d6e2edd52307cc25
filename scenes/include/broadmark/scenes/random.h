// Portable random numbers: the standard defines the generator, but the sampling is implemented
// here, because the standard's distributions differ between libraries.
//
// Example:
//
//   scenes::Random random(7);  // the same numbers on every machine
//   const double speed = random.between(1, 3);
//   const Vec3 velocity = random.inBall(speed);
//   std::vector<int> order = {0, 1, 2, 3};
//   random.shuffle(order);
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include "broadmark/pose.h"

namespace broadmark::scenes {

/// The 64-bit Mersenne Twister. Copies continue independently with the same numbers.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  /// Uniform in [0, 1), in steps of 2^-53.
  double uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  /// Uniform in [low, high); rounding may yield `high`. One call of uniform().
  double between(double low, double high) { return low + (high - low) * uniform(); }
  /// Uniform in the ball of this radius around the origin, up to rounding. A multiple of three
  /// calls of uniform(): about six on average.
  Vec3 inBall(double radius) {
    // Rejection from the cube: exactly uniform, without library functions that might round
    // differently.
    for (;;) {
      const double x = 2 * uniform() - 1;
      const double y = 2 * uniform() - 1;
      const double z = 2 * uniform() - 1;
      if (x * x + y * y + z * z <= 1) {
        return {static_cast<float>(radius * x), static_cast<float>(radius * y),
                static_cast<float>(radius * z)};
      }
    }
  }

  /// A random permutation (Fisher and Yates): one call of uniform() per element but one. O(n).
  template <class Element>
  void shuffle(std::vector<Element>& elements) {
    for (std::size_t left = elements.size(); left > 1; --left) {
      const auto chosen = static_cast<std::size_t>(uniform() * static_cast<double>(left));
      std::swap(elements[left - 1], elements[chosen]);
    }
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace broadmark::scenes
