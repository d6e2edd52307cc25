// What an algorithm took in a span of frames.
#pragma once

#include <cstddef>
#include <vector>

#include "inspector/run/lane.h"
#include "inspector/session/timeline.h"

namespace broadmark {

struct SpanStatistics {
  std::vector<double> values;  ///< of the frames that were run and not disturbed, sorted
  std::size_t disturbed = 0;   ///< frames that were left out for that
  double total = 0;

  /// Only of some values.
  [[nodiscard]] double quantile(double share) const;
};

/// Of the values of some frames. O(n log n) for a span of n.
SpanStatistics statisticsOf(const FrameValues& values, const FrameValues& disturbed,
                            FrameSpan span);

}  // namespace broadmark
