// Statistics of a track in a span of frames, and ratios of two tracks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "inspector/run/algorithm_track.h"
#include "inspector/session/timeline.h"

namespace broadmark {

struct SpanStatistics {
  std::vector<double> values;  ///< of the frames that were run undisturbed, sorted
  std::size_t disturbed = 0;   ///< number of disturbed frames, which are excluded
  double total = 0;
};

/// Computes the statistics of a curve in a span. O(n log n) for n frames.
SpanStatistics statisticsOf(const FrameValues& values, const FrameValues& disturbed,
                            FrameSpan span);

/// Mean time of a phase over the undisturbed frames of a span; nothing without such frames.
std::optional<double> meanSeconds(const TrackReport& track, Phase phase,
                                  FrameSpan span = {1, std::numeric_limits<std::uint32_t>::max()});

/// The slowest of the undisturbed frames of a span.
std::optional<std::uint32_t> slowestFrame(const TrackReport& track, FrameSpan span);

/// Frame times of a first track relative to a second.
struct TimeRatios {
  /// A frame, and its ratio of the first track's time to the second's.
  struct Extreme {
    std::uint32_t frame = 0;
    double ratio = 1;
  };

  FrameValues ratios;               ///< of the frames that both tracks have run undisturbed
  std::uint64_t first_slower = 0;   ///< number of frames
  std::uint64_t second_slower = 0;  ///< number of frames
  double median = 1;
  std::optional<Extreme> highest;  ///< highest ratio; nothing without frames
  std::optional<Extreme> lowest;   ///< lowest ratio
};

/// Compares the total times. O(n log n) for n frames.
TimeRatios ratiosOf(const TrackReport& first, const TrackReport& second);

}  // namespace broadmark
