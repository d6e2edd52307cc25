// What algorithms took: one in a span of frames, or two beside each other.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "inspector/run/algorithm_track.h"
#include "inspector/session/timeline.h"

namespace broadmark {

struct SpanStatistics {
  std::vector<double> values;  ///< of the frames that were run and not disturbed, sorted
  std::size_t disturbed = 0;   ///< frames that were left out for that
  double total = 0;
};

/// Of the values of some frames. O(n log n) for a span of n.
SpanStatistics statisticsOf(const FrameValues& values, const FrameValues& disturbed,
                            FrameSpan span);

/// Which of two algorithms is slower, and in which frames.
struct TimeRatios {
  /// A frame, and how many times as long the first algorithm took there as the second.
  struct Extreme {
    std::uint32_t frame = 0;
    double ratio = 1;
  };

  FrameValues ratios;  ///< of the frames that both have run, and in which neither was disturbed
  std::uint64_t first_slower = 0;   ///< frames
  std::uint64_t second_slower = 0;  ///< frames in which the second track is slower
  double median = 1;
  std::optional<Extreme> highest;  ///< where the first one is slowest beside the second; nothing
                                   ///< without any frame
  std::optional<Extreme> lowest;   ///< of the fastest frame
};

/// Of the total times. O(n log n) for n frames.
TimeRatios ratiosOf(const TrackReport& first, const TrackReport& second);

}  // namespace broadmark
