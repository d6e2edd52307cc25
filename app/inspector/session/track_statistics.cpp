#include "inspector/session/track_statistics.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "broadmark/statistics/statistics.h"

namespace broadmark {
namespace {

/// Calls visit(frame, record) for the frames of a span that were run undisturbed.
template <class Visit>
void visitUndisturbed(const TrackReport& track, FrameSpan span, const Visit& visit) {
  const auto last = std::min<std::size_t>(track.frames.size(), span.last);
  for (std::size_t frame = span.first; frame <= last; ++frame) {
    const FrameRecord& record = track.frames[frame - 1];
    if (record.run && !record.disturbed) visit(static_cast<std::uint32_t>(frame), record);
  }
}

}  // namespace

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

std::optional<double> meanSeconds(const TrackReport& track, Phase phase, FrameSpan span) {
  double sum_ns = 0;
  std::uint64_t count = 0;
  visitUndisturbed(track, span, [&](std::uint32_t, const FrameRecord& record) {
    sum_ns += static_cast<double>(record.times[phase]);
    ++count;
  });
  if (count == 0) return {};
  return sum_ns * 1e-9 / static_cast<double>(count);
}

std::optional<std::uint32_t> slowestFrame(const TrackReport& track, FrameSpan span) {
  std::optional<std::uint32_t> slowest;
  std::int64_t longest = -1;
  visitUndisturbed(track, span, [&](std::uint32_t frame, const FrameRecord& record) {
    if (record.times[Phase::total] <= longest) return;
    longest = record.times[Phase::total];
    slowest = frame;
  });
  return slowest;
}

TimeRatios ratiosOf(const TrackReport& first, const TrackReport& second) {
  TimeRatios result;
  std::vector<double> ratios;
  const std::size_t frames = std::min(first.frames.size(), second.frames.size());
  for (std::uint32_t frame = 1; frame <= frames; ++frame) {
    const FrameRecord* const a = first.record(frame);
    const FrameRecord* const b = second.record(frame);
    if (a == nullptr || b == nullptr || a->disturbed || b->disturbed) continue;
    const double ratio = static_cast<double>(std::max<std::int64_t>(a->times[Phase::total], 1)) /
                         static_cast<double>(std::max<std::int64_t>(b->times[Phase::total], 1));
    result.ratios.set(frame, static_cast<float>(ratio));
    ratios.push_back(ratio);
    if (ratio > 1) ++result.first_slower;
    if (ratio < 1) ++result.second_slower;
    if (!result.highest || ratio > result.highest->ratio) result.highest = {frame, ratio};
    if (!result.lowest || ratio < result.lowest->ratio) result.lowest = {frame, ratio};
  }
  if (!ratios.empty()) result.median = quantile(ratios, 0.5);
  return result;
}

}  // namespace broadmark
