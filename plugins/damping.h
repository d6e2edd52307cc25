// Converts our damping setting to the SDKs' damping coefficient.
#pragma once

#include <cmath>

namespace broadmark::scenes {

/// The coefficient c in dv/dt = -c v for a body that loses this share of its velocity per second.
inline float dampingFactor(double share_per_second) {
  constexpr double kMaxFactor = 1e6;  // stops the body at once
  return static_cast<float>(share_per_second >= 1 ? kMaxFactor : -std::log(1 - share_per_second));
}

}  // namespace broadmark::scenes
