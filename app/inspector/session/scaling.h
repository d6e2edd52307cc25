// How the time of a frame grows with the number of bodies, from cases of the same scene in several
// sizes.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "broadmark/algorithm.h"
#include "broadmark/results/results.h"

namespace broadmark {

/// A case that may become a point; borrowed.
struct SizedCase {
  std::size_t row = 0;  ///< in the list that it comes from
  const CaseResult* result = nullptr;
  std::string algorithm;  ///< its name, as short as it stands in that list
};

struct ScalingPoint {
  std::uint32_t objects = 0;
  double seconds = 0;  ///< mean per frame, over all repetitions; above 0
  std::size_t row = 0;
};

/// One algorithm, with the same parameters and threads, on one scene.
struct ScalingCurve {
  std::string algorithm;             ///< as short as tells it from all others
  std::string scene;                 ///< "Brownian/Cubes/F9"; "" where all curves are of the same
  std::vector<ScalingPoint> points;  ///< of at least two sizes, the smallest first
  double exponent = 0;  ///< of seconds = factor · objects^exponent, by least squares of logarithms
};

/// The curves of a phase, in the order of the cases. Only complete cases whose answers were right
/// have points, and none has one where the phase took no time.
std::vector<ScalingCurve> scalingCurves(std::span<const SizedCase> cases, Phase phase);

}  // namespace broadmark
