#include "broadmark/render/plot.h"

#include <gtest/gtest.h>

#include <cmath>

namespace broadmark::tests {
namespace {

TEST(Plot, NumbersHaveSiPrefixes) {
  EXPECT_EQ(withPrefix(0.00125, "s"), "1.25 ms");
  EXPECT_EQ(withPrefix(2.5e-7, "s"), "250 ns");
  EXPECT_EQ(withPrefix(0, "s"), "0 s");
  EXPECT_EQ(withPrefix(3, "s"), "3 s");
  EXPECT_EQ(withPrefix(4e-10, "s"), "0.4 ns");
  EXPECT_EQ(withPrefix(1234, ""), "1234");
}

TEST(Plot, TicksAreRoundAndWithinTheAxis) {
  for (const bool logarithmic : {false, true}) {
    for (const double high : {1e-6, 0.37, 1.0, 9999.0}) {
      const double low = logarithmic ? high / 1234 : 0;
      for (const int count : {1, 3, 10}) {
        const std::vector<double> ticks = axisTicks(low, high, count, logarithmic);
        EXPECT_LE(ticks.size(), static_cast<std::size_t>(3 * count + 2));
        for (const double tick : ticks) {
          EXPECT_GE(tick, low);
          EXPECT_LE(tick, high * (1 + 1e-12));
        }
        // Steps of 1, 2 or 5 times a power of ten; powers of ten with 2 and 5 between them.
        for (std::size_t i = 0; i < ticks.size(); ++i) {
          if (!logarithmic && i == 0) continue;
          const double round = logarithmic ? ticks[i] : ticks[i] - ticks[i - 1];
          const double leading = round / std::pow(10, std::floor(std::log10(round) + 1e-9));
          EXPECT_TRUE(std::abs(leading - 1) < 1e-6 || std::abs(leading - 2) < 1e-6 ||
                      std::abs(leading - 5) < 1e-6)
              << leading;
        }
      }
    }
  }
  EXPECT_TRUE(axisTicks(1, 1, 5, false).empty());
}

}  // namespace
}  // namespace broadmark::tests
