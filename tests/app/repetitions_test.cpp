// When to stop repeating a case, and the order of interleaved cases.

#include "request/repetitions.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace broadmark::tests {
namespace {

using testing::ElementsAre;
using testing::UnorderedElementsAre;

/// A result with one frame per repetition; `ns`: the time of each.
CaseResult resultOfFrames(const std::vector<std::int64_t>& ns) {
  CaseResult result;
  for (const std::int64_t time : ns) {
    FrameTimes frame;
    frame[Phase::total] = time;
    result.repetitions.push_back({.frames = {frame}});
  }
  return result;
}

TEST(RepetitionRule, AFixedNumberIsRunWhateverTheTimesAre) {
  const RepetitionOptions options{.max_count = 6};
  const RepetitionRule rule(options);
  EXPECT_FALSE(rule.isEnough(resultOfFrames({100, 100, 100, 100, 100})));
  EXPECT_TRUE(rule.isEnough(resultOfFrames({100, 100, 900, 100, 100, 100})));
  EXPECT_EQ(rule.expected(resultOfFrames({100})), 6);
}

TEST(RepetitionRule, AutoEndsWhenTheMeanIsKnown) {
  const RepetitionOptions options{.max_count = 9, .until_precise = true, .precision = 0.02};
  const RepetitionRule rule(options);
  EXPECT_FALSE(rule.isEnough(resultOfFrames({1000, 1000, 1000, 1000}))) << "too few";
  EXPECT_TRUE(rule.isEnough(resultOfFrames({1000, 1000, 1000, 1000, 1000})));
  EXPECT_TRUE(rule.isEnough(resultOfFrames({1000, 1003, 997, 1005, 998})));
  EXPECT_FALSE(rule.isEnough(resultOfFrames({1000, 1030, 970, 1050, 980})));
  EXPECT_TRUE(rule.isEnough(resultOfFrames({1, 5, 1, 5, 1, 5, 1, 5, 1}))) << "the most";
  EXPECT_EQ(rule.expected(resultOfFrames({1, 1, 1, 1, 1})), 5);
}

TEST(RepetitionRule, AutoEndsWhenTimeIsUpButNotBeforeFive) {
  const RepetitionOptions options{.max_count = 9, .until_precise = true, .max_seconds = 0};
  const RepetitionRule rule(options);
  EXPECT_FALSE(rule.isEnough(resultOfFrames({1, 5, 1, 5})));
  EXPECT_TRUE(rule.isEnough(resultOfFrames({1, 5, 1, 5, 1})));
}

TEST(TurnOrder, ASeedGivesTheSameOrdersAgain) {
  constexpr std::size_t kCases = 5;
  const auto orders = [](std::uint64_t seed) {
    TurnOrder order(kCases, seed);
    std::vector<std::vector<std::size_t>> all = {order.cases()};
    for (int pass = 0; pass < 4; ++pass) {
      order.shuffle();
      all.push_back(order.cases());
    }
    return all;
  };
  const auto first = orders(1);
  EXPECT_THAT(first.front(), ElementsAre(0, 1, 2, 3, 4));
  for (const auto& order : first) EXPECT_THAT(order, UnorderedElementsAre(0, 1, 2, 3, 4));
  EXPECT_GT(std::set(first.begin(), first.end()).size(), 2U);
  EXPECT_EQ(orders(1), first);
  EXPECT_NE(orders(2), first);
}

}  // namespace
}  // namespace broadmark::tests
