#include "inspector/run/answer_cache.h"

#include <gtest/gtest.h>

#include "engine/helpers.h"

namespace broadmark::tests {
namespace {

CachedAnswer answerOf(std::vector<Pair> pairs) { return {.pairs = std::move(pairs)}; }

/// `count` pairs of disjoint bodies.
std::vector<Pair> manyPairs(std::uint32_t count) {
  std::vector<Pair> pairs;
  for (std::uint32_t i = 0; i < count; ++i) pairs.push_back({i * 7919 % count, i});
  return pairs;
}

TEST(PackedPairsTest, UnpacksTheSamePairsInTheSameOrder) {
  const std::vector<std::vector<Pair>> lists = {
      {}, {{0, 1}}, {{5, 3}, {4, 4}, {4, 4}}, {{0xFFFFFFFF, 0}, {0, 0xFFFFFFFF}}, manyPairs(1000)};
  for (const auto& pairs : lists) EXPECT_EQ(PackedPairs(pairs).unpacked(), pairs);
}

TEST(PackedPairsTest, TakesAboutHalfTheMemory) {
  std::vector<Pair> pairs;
  for (std::uint32_t i = 0; i < 100'000; ++i) pairs.push_back({i, i * 31 % 100'000});
  EXPECT_LE(PackedPairs(pairs).bytes(), pairs.size() * 4);
}

TEST(SeenAnswersTest, AreToldApartByLaneAndFrame) {
  AnswerCache seen(1 << 20);
  CachedAnswer wrong = answerOf({{1, 2}});
  wrong.checked = true;
  wrong.difference = FrameDifference{.missed_count = 1, .missed_pairs = {{3, 4}}};
  wrong.oracle_pairs = {{1, 2}, {3, 4}};
  wrong.counters = {{"tests", 7}};
  seen.insert(1, 10, wrong);
  seen.insert(2, 10, answerOf({{5, 6}}));
  const auto recalled = seen.find(1, 10);
  ASSERT_TRUE(recalled);
  EXPECT_EQ(recalled->pairs, wrong.pairs);
  EXPECT_EQ(recalled->oracle_pairs, wrong.oracle_pairs);
  EXPECT_EQ(recalled->difference->missed_pairs, wrong.difference->missed_pairs);
  EXPECT_EQ(recalled->counters, wrong.counters);
  EXPECT_EQ(seen.find(2, 10)->pairs, (std::vector<Pair>{{5, 6}}));
  EXPECT_FALSE(seen.find(1, 11));
  EXPECT_TRUE(seen.contains(1, 10, true));
  EXPECT_FALSE(seen.contains(2, 10, true));
  EXPECT_TRUE(seen.contains(2, 10, false));
  seen.erase(1);
  EXPECT_FALSE(seen.find(1, 10));
  EXPECT_TRUE(seen.find(2, 10));
  seen.clear();
  EXPECT_FALSE(seen.find(2, 10));
  EXPECT_EQ(seen.bytes(), 0U);
}

TEST(SeenAnswersTest, TheOldestGiveWayToTheBudget) {
  constexpr std::size_t kBudget = 100'000;
  AnswerCache seen(kBudget);
  for (std::uint32_t frame = 0; frame < 100; ++frame) {
    seen.insert(1, frame, answerOf(manyPairs(1000)));
    EXPECT_LE(seen.bytes(), kBudget);
    EXPECT_TRUE(seen.find(1, frame));
  }
  EXPECT_FALSE(seen.find(1, 0));
  EXPECT_TRUE(seen.find(1, 98));
  // Storing an answer again makes it the newest.
  std::uint32_t oldest = 0;
  while (!seen.find(1, oldest)) ++oldest;
  const std::size_t before = seen.bytes();
  seen.insert(1, oldest, answerOf(manyPairs(1000)));
  EXPECT_EQ(seen.bytes(), before);
  seen.insert(1, 100, answerOf(manyPairs(1000)));
  EXPECT_TRUE(seen.find(1, oldest));
  EXPECT_FALSE(seen.find(1, oldest + 1));
  // An answer larger than the cache is not stored, and evicts no other.
  seen.insert(1, 500, answerOf(manyPairs(100'000)));
  EXPECT_FALSE(seen.find(1, 500));
  EXPECT_TRUE(seen.find(1, 100));
}

}  // namespace
}  // namespace broadmark::tests
