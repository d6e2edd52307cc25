// The base classes of algorithms: their own behaviour, and the mistakes that they detect.

#include <gtest/gtest.h>

#include <stdexcept>

#include "algorithms/runs.h"

namespace broadmark::tests {
namespace {

/// Each worker reports the pair (worker, worker + 1).
class OnePair : public PairBroadPhase {
 public:
  void updateObjects(const Frame&) override {}

 private:
  void findPairs() override {
    for (int worker = 0; worker < team().size(); ++worker) {
      pairs(worker).add(static_cast<std::uint32_t>(worker), static_cast<std::uint32_t>(worker) + 1);
    }
  }
};

/// Overrides initialize() without a call of the base class.
class ForgetfulPair final : public OnePair {
 public:
  void initialize(const SceneInfo&, const Frame&, ExecutionContext&) override {}
};

const std::vector<Aabb> kThreeBoxes = inputs::identical(3, 0, 1);
constexpr Pair kFirst = {0, 1};
constexpr Pair kSecond = {1, 2};

TEST(PairBroadPhase, AnswersWithWhatIsAddedWithoutFurtherCalls) {
  OnePair algorithm;
  ExecutionContext execution(2, Isa::scalar);
  algorithm.initialize({}, {0, kThreeBoxes}, execution);
  algorithm.updateObjects({1, kThreeBoxes});
  algorithm.cleanCache();
  algorithm.updateStructures();
  EXPECT_TRUE(sorted(algorithm.overlaps()).empty());
  algorithm.searchOverlaps();
  EXPECT_EQ(sorted(algorithm.overlaps()), (std::vector{kFirst, kSecond}));
}

TEST(PairBroadPhase, CleanCacheEmptiesAnswerAndBuffers) {
  OnePair algorithm;
  ExecutionContext execution(1, Isa::scalar);
  algorithm.initialize({}, {0, kThreeBoxes}, execution);
  for (std::uint32_t frame = 1; frame < 4; ++frame) {
    algorithm.updateObjects({frame, kThreeBoxes});
    algorithm.cleanCache();
    EXPECT_EQ(pairCount(algorithm.overlaps()), 0U);
    algorithm.searchOverlaps();
    EXPECT_EQ(sorted(algorithm.overlaps()), std::vector{kFirst});
  }
}

TEST(PairBroadPhase, NoticesThatItsInitializeWasNotCalled) {
  ForgetfulPair algorithm;
  ExecutionContext execution(1, Isa::scalar);
  algorithm.initialize({}, {0, kThreeBoxes}, execution);
  algorithm.updateObjects({1, kThreeBoxes});
  algorithm.cleanCache();
  EXPECT_THROW(algorithm.searchOverlaps(), std::logic_error);
}

/// Exposes the boxes that the layer stores.
class StoredBoxes final : public BoxBroadPhase {
 public:
  using BoxBroadPhase::boxes;

 private:
  void findPairs() override {}
};

class StoredArrays final : public SimdBroadPhase {
 public:
  using SimdBroadPhase::arrays;

 private:
  void findPairs() override {}
};

TEST(BoxBroadPhase, KeepsTheBoxesOfTheInitialPoseAndOfEachFrame) {
  StoredBoxes algorithm;
  ExecutionContext execution(1, Isa::scalar);
  const std::vector<Aabb> first = inputs::uniform(20, 0, 1);
  algorithm.initialize({}, {0, first}, execution);
  EXPECT_EQ(algorithm.boxes(), first);
  const std::vector<Aabb> next = inputs::uniform(20, 1, 1);
  algorithm.updateObjects({1, next});
  EXPECT_EQ(algorithm.boxes(), next);
}

TEST(SimdBroadPhase, KeepsTheBoxesOfTheInitialPoseAndOfEachFrame) {
  StoredArrays algorithm;
  ExecutionContext execution(1, Isa::scalar);
  const std::vector<Aabb> first = inputs::uniform(21, 0, 1);
  algorithm.initialize({}, {0, first}, execution);
  ASSERT_EQ(algorithm.arrays().size(), first.size());
  EXPECT_EQ(algorithm.arrays().box(20), first[20]);
  const std::vector<Aabb> next = inputs::uniform(21, 1, 1);
  algorithm.updateObjects({1, next});
  EXPECT_EQ(algorithm.arrays().box(20), next[20]);
}

}  // namespace
}  // namespace broadmark::tests
