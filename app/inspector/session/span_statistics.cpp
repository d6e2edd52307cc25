#include "inspector/session/span_statistics.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "broadmark/statistics/statistics.h"

namespace broadmark {

double SpanStatistics::quantile(double share) const { return broadmark::quantile(values, share); }

SpanStatistics statisticsOf(const FrameValues& values, const FrameValues& disturbed,
                            FrameSpan span) {
  SpanStatistics statistics;
  for (std::uint32_t frame = span.first; frame <= span.last; ++frame) {
    const float value = values.at(frame);
    if (std::isnan(value)) continue;
    if (!std::isnan(disturbed.at(frame))) {
      ++statistics.disturbed;
    } else {
      statistics.values.push_back(value);
    }
  }
  std::ranges::sort(statistics.values);
  statistics.total = std::accumulate(statistics.values.begin(), statistics.values.end(), 0.0);
  return statistics;
}

}  // namespace broadmark
