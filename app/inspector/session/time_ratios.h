// Which of two algorithms is slower, and in which frames.
#pragma once

#include <cstdint>
#include <optional>

#include "inspector/run/lane.h"

namespace broadmark {

struct TimeRatios {
  /// A frame, and how many times as long the first algorithm took there as the second.
  struct Extreme {
    std::uint32_t frame = 0;
    double ratio = 1;
  };

  FrameValues ratios;  ///< of the frames that both have run, and in which neither was disturbed
  std::uint64_t first_slower = 0;   ///< frames
  std::uint64_t second_slower = 0;  ///< likewise
  double median = 1;
  std::optional<Extreme> highest;  ///< where the first one is slowest beside the second; nothing
                                   ///< without any frame
  std::optional<Extreme> lowest;   ///< likewise, where it is quickest
};

/// Of the total times. O(n log n) for n frames.
TimeRatios ratiosOf(const LaneReport& first, const LaneReport& second);

}  // namespace broadmark
