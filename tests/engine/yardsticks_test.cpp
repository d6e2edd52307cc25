// The yardsticks: they measure something, and not too often.

#include "broadmark/harness/yardsticks.h"

#include <gtest/gtest.h>

namespace broadmark::tests {
namespace {

using Clock = Yardsticks::Clock;

TEST(Yardsticks, TakeTime) {
  Yardsticks yardsticks;
  const auto begin = Clock::now();
  const YardstickTimes times = yardsticks.recent();
  const std::chrono::nanoseconds all = Clock::now() - begin;
  for (const auto& yardstick : kYardsticks.entries) {
    EXPECT_GT(times[yardstick.value], 10'000) << yardstick.name;
    EXPECT_LE(times[yardstick.value], all.count()) << yardstick.name;
  }
}

TEST(Yardsticks, AreMeasuredAgainOnlyLater) {
  Yardsticks yardsticks;
  const auto begin = Clock::now();
  const YardstickTimes first = yardsticks.recent();
  EXPECT_EQ(yardsticks.recent(begin + std::chrono::milliseconds(30)).values, first.values);
  const auto later = Clock::now() + std::chrono::milliseconds(31);
  EXPECT_NE(yardsticks.recent(later).values, first.values) << "to the nanosecond";
}

}  // namespace
}  // namespace broadmark::tests
