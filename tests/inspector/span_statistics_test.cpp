// Statistics of an algorithm's times in a span of frames.
#include "inspector/session/track_statistics.h"

#include <gtest/gtest.h>

#include "broadmark/statistics/statistics.h"

namespace broadmark::tests {
namespace {

TEST(SpanStatistics, AreOfTheFramesThatWereRunAndNotDisturbed) {
  FrameValues seconds;
  FrameValues disturbed;
  for (std::uint32_t frame = 1; frame <= 20; ++frame) {
    if (frame != 12) seconds.set(frame, static_cast<float>(frame));
  }
  disturbed.set(14, 1);
  const SpanStatistics of = statisticsOf(seconds, disturbed, {10, 16});
  EXPECT_EQ(of.values, (std::vector<double>{10, 11, 13, 15, 16}));
  EXPECT_EQ(of.disturbed, 1U);
  EXPECT_EQ(of.total, 65);
  EXPECT_EQ(quantile(of.values, 0.5), 13);
  EXPECT_EQ(quantile(of.values, 1), 16);
  EXPECT_TRUE(statisticsOf(seconds, disturbed, {30, 40}).values.empty());
}

}  // namespace
}  // namespace broadmark::tests
