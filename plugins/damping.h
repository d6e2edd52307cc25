// A setting of ours as the engines of SDKs have it.
#pragma once

#include <cmath>

namespace broadmark::scenes {

/// The factor c of dv/dt = -c v for a body that loses this share of its velocity per second.
inline float dampingFactor(double share_per_second) {
  constexpr double kMost = 1e6;  // all of it at once
  return static_cast<float>(share_per_second >= 1 ? kMost : -std::log(1 - share_per_second));
}

}  // namespace broadmark::scenes
