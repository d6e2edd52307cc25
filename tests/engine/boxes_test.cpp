// Boxes, pairs, pair buffers and structures of arrays.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <list>

#include "broadmark/broad_phase.h"
#include "engine/helpers.h"

namespace broadmark::tests {
namespace {

using testing::ElementsAre;

TEST(Aabb, TouchingBoxesOverlapOnEveryAxis) {
  const Aabb box = unitBox(0);
  for (int axis = 0; axis < 3; ++axis) {
    for (const float direction : {-1.0F, 1.0F}) {
      Aabb neighbour = box;
      neighbour.min[axis] += direction;
      neighbour.max[axis] += direction;
      EXPECT_TRUE(overlaps(box, neighbour));
      EXPECT_TRUE(overlaps(neighbour, box));

      // The smallest gap that a float can represent.
      float& near_bound = direction > 0 ? neighbour.min[axis] : neighbour.max[axis];
      near_bound = std::nextafter(near_bound, near_bound + direction);
      EXPECT_FALSE(overlaps(box, neighbour));
      EXPECT_FALSE(overlaps(neighbour, box));
    }
  }
}

TEST(Aabb, PaddingDoesNotTakePart) {
  Aabb a = unitBox(0);
  a.min[3] = 5;
  a.max[3] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(overlaps(a, unitBox(0.5F)));
}

TEST(Aabb, EnlargedAndMerged) {
  const Aabb box = {{0, 1, 2, 0}, {3, 4, 5, 0}};
  EXPECT_EQ(enlarged(box, 0.5F), (Aabb{{-0.5F, 0.5F, 1.5F, 0}, {3.5F, 4.5F, 5.5F, 0}}));
  EXPECT_EQ(merged(box, {{-1, 2, 1, 0}, {1, 9, 3, 0}}), (Aabb{{-1, 1, 1, 0}, {3, 9, 5, 0}}));
}

TEST(Pair, OrderedWhicheverWayRound) {
  EXPECT_EQ(orderedPair(7, 3), (Pair{3, 7}));
  EXPECT_EQ(orderedPair(3, 7), (Pair{3, 7}));
  EXPECT_LT((Pair{1, 9}), (Pair{2, 0}));
}

TEST(PairBuffer, KeepsPairsWhileGrowing) {
  constexpr std::uint32_t kCount = 5000;
  PairBuffer buffer;
  for (std::uint32_t i = 0; i < kCount; ++i) buffer.add(i + 1, i);
  ASSERT_EQ(buffer.size(), kCount);
  for (std::uint32_t i = 0; i < kCount; ++i) EXPECT_EQ(buffer.run()[i], (Pair{i, i + 1}));
}

TEST(PairBuffer, KeepsItsRoomWhenCleared) {
  PairBuffer buffer;
  const Pair* const room = buffer.room(10'000);
  buffer.advance(10'000);
  buffer.clear();
  EXPECT_EQ(buffer.size(), 0U);
  EXPECT_EQ(buffer.room(10'000), room);
}

TEST(PairBuffer, RoomCountsOnlyAfterAdvance) {
  PairBuffer buffer;
  buffer.add(0, 1);
  Pair* const room = buffer.room(3);
  room[0] = {2, 3};
  room[1] = {4, 5};
  EXPECT_EQ(buffer.size(), 1U);
  buffer.advance(1);
  EXPECT_THAT(buffer.run(), ElementsAre(Pair{0, 1}, Pair{2, 3}));
}

TEST(PairBuffer, MapsEachPairOnceInBlocksOfAnySize) {
  struct EvenDoubled final : PairMap {
    std::size_t map(std::span<Pair> pairs) const override {
      std::size_t count = 0;
      for (const Pair pair : pairs) {
        pairs[count] = {2 * pair.a, 2 * pair.b};
        count += pair.a % 2 == 0 ? 1 : 0;
      }
      return count;
    }
  };
  const EvenDoubled map;
  PairBuffer buffer;
  buffer.setMap(&map);
  for (const std::size_t step : {1U, 7U, 1024U, 5000U}) {
    SCOPED_TRACE(step);
    buffer.clear();
    for (std::uint32_t i = 0; i < 12'000;) {
      Pair* const room = buffer.room(step);
      for (std::size_t k = 0; k < step; ++k, ++i) room[k] = {i, i + 1};
      buffer.advance(step);
    }
    buffer.flush();
    buffer.flush();
    ASSERT_GE(buffer.size(), 6'000U);
    for (std::uint32_t i = 0; i < buffer.size(); ++i) {
      ASSERT_EQ(buffer.run()[i], (Pair{4 * i, 4 * i + 2}));
    }
  }
}

TEST(BoxArrays, TransposesAndPadsForEverySize) {
  BoxArrays arrays;
  for (const std::size_t n : {0U, 1U, 15U, 16U, 17U, 100U, 3U}) {
    SCOPED_TRACE(n);
    const std::vector<Aabb> boxes = chain(n);
    arrays.assign(boxes);
    ASSERT_EQ(arrays.size(), n);
    for (std::size_t i = 0; i < n; ++i) EXPECT_EQ(arrays.box(i), boxes[i]);

    const Aabb huge = {{-1e30F, -1e30F, -1e30F, 0}, {1e30F, 1e30F, 1e30F, 0}};
    for (std::size_t i = n; i < n + BoxArrays::kPadding; ++i) {
      EXPECT_FALSE(overlaps(arrays.box(i), huge));
      EXPECT_FALSE(overlaps(huge, arrays.box(i)));
      EXPECT_FALSE(overlaps(arrays.box(i), arrays.box(i)));
    }
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(reinterpret_cast<std::uintptr_t>(arrays.min(axis)) % 64, 0U);
      EXPECT_EQ(reinterpret_cast<std::uintptr_t>(arrays.max(axis)) % 64, 0U);
    }
  }
}

TEST(BoxArrays, KeepsItsRoomWhenShrunk) {
  BoxArrays arrays;
  arrays.resize(1000);
  const float* const room = arrays.min(0);
  arrays.resize(10);
  arrays.resize(1000);
  EXPECT_EQ(arrays.min(0), room);
}

// Slow growth must not allocate in every frame.
TEST(BoxArrays, GrowsAgainByLargerSteps) {
  BoxArrays arrays;
  arrays.resize(1000);
  arrays.resize(1100);
  const float* const room = arrays.min(0);
  arrays.resize(1400);
  EXPECT_EQ(arrays.min(0), room);
}

TEST(OverlapCounts, CountsEachBodysPairs) {
  const std::vector<Pair> first = {{0, 1}, {1, 2}};
  const std::vector<Pair> second = {{1, 3}, {3, 9}};
  const PairRun runs[] = {first, second};
  EXPECT_THAT(overlapCounts(4, runs), ElementsAre(1, 3, 1, 1));
  EXPECT_THAT(overlapCounts(0, runs), ElementsAre());
}

/// A minimal broad phase on the helper layers.
class OnePairPerWorker final : public BoxBroadPhase {
 public:
  void findPairs() override {
    team().run([&](int worker) { pairs(worker).add(0, static_cast<std::uint32_t>(worker) + 1); });
  }
  using BoxBroadPhase::boxes;
};

TEST(HelperLayers, OneRunOfPairsPerWorkerUntilTheNextFrame) {
  ExecutionContext execution(3, Isa::scalar);
  OnePairPerWorker broad_phase;
  const std::vector<Aabb> first = chain(4);
  broad_phase.initialize({.objects = 4}, {0, first}, execution);
  EXPECT_EQ(broad_phase.boxes(), first);

  const std::vector<Aabb> next(4, unitBox(9));
  for (std::uint32_t index = 1; index < 4; ++index) {
    broad_phase.updateObjects({index, next});
    broad_phase.cleanCache();
    broad_phase.updateStructures();
    broad_phase.searchOverlaps();
    EXPECT_EQ(broad_phase.boxes(), next);
    ASSERT_EQ(broad_phase.overlaps().size(), 3U);
    EXPECT_EQ(pairCount(broad_phase.overlaps()), 3U);
    EXPECT_THAT(broad_phase.overlaps()[2], ElementsAre(Pair{0, 3}));
  }
}

}  // namespace
}  // namespace broadmark::tests
