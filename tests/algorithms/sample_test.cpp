// The trimmed range of a sample.

#include "sample.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <vector>

#include "torture/inputs.h"

namespace broadmark {
namespace {

/// trimmedRange(), by sorting.
TrimmedRange trimmedRangeBySorting(const std::vector<Aabb>& sample, int axis) {
  std::vector<double> lows;
  std::vector<double> highs;
  for (const Aabb& box : sample) {
    lows.push_back(box.min[axis]);
    highs.push_back(box.max[axis]);
  }
  std::ranges::sort(lows);
  std::ranges::sort(highs, std::greater());
  const auto rank = static_cast<std::size_t>(0.05 * static_cast<double>(sample.size() - 1));
  const double margin = (highs[rank] - lows[rank]) / 4;
  return {std::max(lows[0], lows[rank] - margin), std::min(highs[0], highs[rank] + margin)};
}

// Also sorted and reversed samples, in which every 16th value is no random sample.
TEST(Sample, FindsTheTrimmedRange) {
  for (const inputs::Input& input : inputs::kAll) {
    for (const std::size_t size : {1U, 2U, 15U, 16U, 17U, 100U, 256U, 1000U, 2047U, 2048U}) {
      SCOPED_TRACE(testing::Message() << input.name << ", " << size);
      std::vector<Aabb> sample = input.boxes(static_cast<std::uint32_t>(size), 0, 1);
      std::erase_if(sample, isEmpty);
      if (sample.empty()) continue;
      for (int order = 0; order < 3; ++order) {
        if (order == 1) {
          std::ranges::sort(sample, {}, [](const Aabb& box) { return box.min[0]; });
        } else if (order == 2) {
          std::ranges::reverse(sample);
        }
        for (int axis = 0; axis < 3; ++axis) {
          const TrimmedRange expected = trimmedRangeBySorting(sample, axis);
          const TrimmedRange range = trimmedRange(sample, axis);
          EXPECT_EQ(range.low, expected.low);
          EXPECT_EQ(range.high, expected.high);
        }
      }
    }
  }
}

}  // namespace
}  // namespace broadmark
