// The yardsticks: they measure something, and not too often.

#include "broadmark/harness/yardsticks.h"

#include <gtest/gtest.h>

namespace broadmark::tests {
namespace {

TEST(Yardsticks, TakeTime) {
  Yardsticks yardsticks;
  const YardstickTimes times = yardsticks.recent();
  for (const auto& yardstick : kYardsticks.entries) {
    EXPECT_GT(times[yardstick.value], 10'000) << yardstick.name;
    EXPECT_LT(times[yardstick.value], 1'000'000'000) << yardstick.name;
  }
}

TEST(Yardsticks, AreNotMeasuredAgainAtOnce) {
  Yardsticks yardsticks;
  EXPECT_EQ(yardsticks.recent().values, yardsticks.recent().values);
}

}  // namespace
}  // namespace broadmark::tests
