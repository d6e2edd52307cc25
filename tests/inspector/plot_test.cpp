#include "broadmark/render/plot.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <random>
#include <set>
#include <vector>

namespace broadmark::tests {
namespace {

TEST(Plot, NumbersHaveSiPrefixes) {
  EXPECT_EQ(withPrefix(0.00125, "s"), "1.25 ms");
  EXPECT_EQ(withPrefix(2.5e-7, "s"), "250 ns");
  EXPECT_EQ(withPrefix(0, "s"), "0 s");
  EXPECT_EQ(withPrefix(3, "s"), "3 s");
  EXPECT_EQ(withPrefix(4e-10, "s"), "0.4 ns");
  EXPECT_EQ(withPrefix(1999.6, "s"), "2000 s");
  EXPECT_EQ(withPrefix(1234, ""), "1234");
  EXPECT_EQ(withPrefix(5000, ""), "5k");
  EXPECT_EQ(withPrefix(9999.9, ""), "10k");
  EXPECT_EQ(withPrefix(12'345, ""), "12.3k");
  EXPECT_EQ(withPrefix(999'700, ""), "1M");
  EXPECT_EQ(withPrefix(2.5e9, ""), "2.5G");
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
        // Linear steps and logarithmic ticks are 1, 2 or 5 times a power of ten.
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

TEST(Plot, TicksShowTheScaleInLittleSpace) {
  EXPECT_EQ(axisTicks(0, 4.2, 2, false), (std::vector<double>{0, 2, 4}));
  EXPECT_EQ(axisTicks(130, 190, 3, true), (std::vector<double>{140, 160, 180}));
}

TEST(Plot, BlocksAreNoWiderThanAPixelAndNoNarrowerThanHalf) {
  EXPECT_EQ(plotLevel(0.01), 0U);
  for (const double frames : {1.0, 1.9, 2.0, 3.0, 100.0, 125.0, 1e6}) {
    const double block = std::exp2(plotLevel(frames));
    EXPECT_LE(block, frames);
    EXPECT_GT(2 * block, frames);
  }
}

// Compared with a linear search, for values set in random order.
TEST(FrameValues, KnowsLowestHighestAndFirstOfAnyFrames) {
  for (const std::uint32_t frames : {1U, 2U, 5U, 64U, 1000U}) {
    std::mt19937 engine(frames);
    const auto below = [&](std::uint32_t bound) {
      return std::uniform_int_distribution<std::uint32_t>(0, bound - 1)(engine);
    };
    FrameValues values;
    std::vector<float> plain(frames, FrameValues::kUnknown);
    for (std::uint32_t step = 0; step < 3 * frames; ++step) {
      const std::uint32_t frame = below(frames);
      const float value = below(3) == 0 ? FrameValues::kUnknown : static_cast<float>(below(100));
      values.set(frame, value);
      plain[frame] = value;
      const std::uint32_t first = below(frames);
      const std::uint32_t last = first + below(frames);  // perhaps beyond the end
      FrameValues::Range range;
      std::optional<std::uint32_t> known;
      std::optional<std::uint32_t> highest;
      for (std::uint32_t i = first; i <= last && i < frames; ++i) {
        range = {std::fmin(range.low, plain[i]), std::fmax(range.high, plain[i])};
        if (!known && !std::isnan(plain[i])) known = i;
        if (plain[i] > (highest ? plain[*highest] : -1)) highest = i;
      }
      const FrameValues::Range found = values.within(first, last);
      ASSERT_EQ(found.known(), range.known());
      if (range.known()) {
        ASSERT_EQ(found.low, range.low);
        ASSERT_EQ(found.high, range.high);
      }
      ASSERT_EQ(values.firstKnown(first, last), known);
      ASSERT_EQ(values.highest(first, last), highest);
    }
  }
}

// A plot of 800 pixels shows each of a few marks among many frames, in a block of its own.
TEST(FrameValues, ThinningLosesNoMark) {
  constexpr std::uint32_t kPlotted = 100'000;
  FrameValues marks;
  marks.set(kPlotted - 1, FrameValues::kUnknown);
  const std::vector<std::uint32_t> marked = {0, 1, 4711, 50'000, kPlotted - 1};
  for (const std::uint32_t frame : marked) marks.set(frame, 1);
  const unsigned level = plotLevel(kPlotted / 800.0);
  std::set<std::uint32_t> seen;
  for (std::uint32_t block = 0; block <= (kPlotted - 1) >> level; ++block) {
    if (marks.block(level, block).known()) seen.insert(block);
  }
  std::set<std::uint32_t> wanted;
  for (const std::uint32_t frame : marked) wanted.insert(frame >> level);
  EXPECT_EQ(seen, wanted);
  EXPECT_FALSE(marks.block(level, kPlotted).known());
  EXPECT_TRUE(marks.block(30, 0).known());
}

}  // namespace
}  // namespace broadmark::tests
