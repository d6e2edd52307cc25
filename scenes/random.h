// Random numbers that are the same everywhere: the engine is fixed by the C++ standard, and the
// sampling is written out, since the standard's distributions differ between libraries.
#pragma once

#include <cstdint>
#include <random>

#include "scenes/pose.h"

namespace broadmark::scenes {

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  /// Uniform in [0, 1), in steps of 2^-53.
  double uniform();
  /// Uniform in the ball of this radius around the origin.
  Vec3 inBall(double radius);

 private:
  std::mt19937_64 engine_;
};

}  // namespace broadmark::scenes
