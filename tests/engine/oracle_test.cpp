// The oracle against the definition, and comparison of answers with it.

#include "broadmark/harness/oracle.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "algorithms/runs.h"
#include "broadmark/harness/runner.h"
#include "engine/helpers.h"
#include "support/changing_worlds.h"
#include "torture/inputs.h"

namespace broadmark::tests {
namespace {

using testing::ElementsAre;
using testing::ElementsAreArray;

PairDigest digestOf(std::vector<Pair> pairs) {
  const PairRun span = pairs;
  return digest({&span, 1});
}

FrameDifference compare(const std::vector<Pair>& answer, const std::vector<Aabb>& boxes,
                        float margin = 0) {
  const PairRun span = answer;
  return findDifference({&span, 1}, bruteForcePairs(boxes), {.index = 7, .boxes = boxes}, margin);
}

TEST(BruteForce, FindsTheObviousPairs) {
  const std::vector<Aabb> boxes = {unitBox(0), unitBox(5), unitBox(0.5F), unitBox(1)};
  EXPECT_THAT(bruteForcePairs(boxes), ElementsAre(Pair{0, 2}, Pair{0, 3}, Pair{2, 3}));
  EXPECT_TRUE(bruteForcePairs({}).empty());
}

TEST(Sweep, EqualsBruteForceOnAllInputs) {
  for (const inputs::Input& input : inputs::kAll) {
    for (const std::size_t n : {0, 1, 2, 3, 17, 100, 299, 700}) {
      for (const std::uint32_t frame : {0, 1, 5}) {
        const std::vector<Aabb> boxes = input.boxes(n, frame, 42);
        ASSERT_THAT(sweptPairs(boxes), ElementsAreArray(bruteForcePairs(boxes)))
            << input.name << ", n = " << n << ", frame " << frame;
      }
    }
  }
}

TEST(Sweep, EqualsBruteForceOnRandomSizes) {
  std::mt19937 random(1);
  constexpr int kRounds = kSanitized ? 20 : 100;
  for (int round = 0; round < kRounds; ++round) {
    const inputs::Input& input = inputs::kAll[random() % inputs::kAll.size()];
    const std::size_t n = random() % 1500;
    const std::vector<Aabb> boxes = input.boxes(n, random() % 8, random());
    ASSERT_EQ(sweptPairs(boxes), bruteForcePairs(boxes)) << input.name << ", n = " << n;
  }
}

TEST(Sweep, FindsNoMorePairsThanAskedFor) {
  const std::vector<Aabb> boxes = inputs::identical(400, 0, 1);
  constexpr std::size_t kPairs = 400 * 399 / 2;
  EXPECT_EQ(sweptPairs(boxes, {}, {}, kPairs).size(), kPairs);
  EXPECT_THROW(sweptPairs(boxes, {}, {}, kPairs - 1), InputError);
  Oracle oracle(std::size_t{1} << 30, kPairs - 1);
  for (int pass = 0; pass < 2; ++pass) {  // an incomplete answer is not cached
    EXPECT_THROW(oracle.pairDigest(boxes), InputError);
  }
  EXPECT_EQ(oracle.pairs(inputs::identical(399, 0, 1)).size(), 399 * 398 / 2);
}

TEST(Sweep, CopesWithTheLargestFloats) {
  for (const std::size_t n : {2, 40, 400}) {
    const std::vector<Aabb> boxes = inputs::limits(n, 1, 3);
    EXPECT_EQ(sweptPairs(boxes), bruteForcePairs(boxes));
  }
}

TEST(Sweep, EqualsBruteForceWhateverIsWantedAndPresent) {
  for (const std::size_t n : {1, 2, 40, 400}) {
    for (const auto& [name, filter] : filters(n)) {
      for (const Presence& present : {Presence(presences::random), Presence(presences::never)}) {
        const auto boxes = framesWith({"clustered", inputs::clustered}, n, 1, present)[0];
        EXPECT_EQ(sweptPairs(boxes, filter), bruteForcePairs(boxes, filter)) << name;
      }
    }
  }
}

TEST(Digest, IsTheSameInAnyOrderAndSplit) {
  std::vector<Pair> pairs = bruteForcePairs(inputs::clustered(100, 1, 1));
  const PairDigest expected = digestOf(pairs);
  EXPECT_EQ(expected.count, pairs.size());
  std::ranges::shuffle(pairs, std::mt19937(5));
  EXPECT_EQ(digestOf(pairs), expected);
  const PairRun all = pairs;
  const PairRun runs[] = {all.first(10), {}, all.subspan(10)};
  EXPECT_EQ(digest(runs), expected);
}

TEST(Digest, ChangesWithEverySinglePair) {
  const std::vector<Pair> pairs = {{0, 1}, {1, 2}, {2, 3}};
  const PairDigest expected = digestOf(pairs);
  EXPECT_NE(digestOf({{0, 1}, {1, 2}}), expected);
  EXPECT_NE(digestOf({{0, 1}, {1, 2}, {2, 4}}), expected);
  EXPECT_NE(digestOf({{0, 1}, {1, 2}, {3, 2}}), expected);
  EXPECT_NE(digestOf({{0, 1}, {1, 2}, {2, 3}, {2, 3}}), expected);
  // A missed and a duplicate pair: the count is right, the hash is not.
  EXPECT_NE(digestOf({{0, 1}, {1, 2}, {1, 2}}).hash, expected.hash);
}

TEST(Oracle, IsRightWithAnyBudget) {
  std::vector<std::vector<Aabb>> frames;
  for (std::uint32_t f = 0; f < 4; ++f) frames.push_back(inputs::teleporting(400, f, 9));
  // Memory for no frame, for about one, and for all frames.
  for (const std::size_t budget : {std::size_t{0}, std::size_t{20'000}, std::size_t{1} << 30}) {
    Oracle oracle(budget);
    for (int pass = 0; pass < 2; ++pass) {
      for (std::uint32_t f = 0; f < frames.size(); ++f) {
        const std::vector<Pair> right = bruteForcePairs(frames[f]);
        ASSERT_EQ(oracle.pairDigest(frames[f]), digestOf(right));
        ASSERT_THAT(oracle.pairs(frames[f]), ElementsAreArray(right));
      }
    }
  }
}

// The same frame number of another scene must not return the cached answer of the first scene.
TEST(Oracle, AnswersForTheBoxesItIsGiven) {
  Oracle oracle;
  const std::vector<Aabb> three = chain(3);
  const std::vector<Aabb> apart = {unitBox(0), unitBox(5), unitBox(10)};
  EXPECT_EQ(oracle.pairs(three).size(), 2U);
  EXPECT_EQ(oracle.pairs(apart).size(), 0U);
  EXPECT_EQ(oracle.pairDigest(apart).count, 0U);
  EXPECT_EQ(oracle.pairDigest(three).count, 2U);
  EXPECT_EQ(oracle.pairs(three).size(), 2U);
}

// Another filter must not return the cached answer either.
TEST(Oracle, AnswersForTheFilterItIsGiven) {
  Oracle oracle;
  const std::vector<Aabb> boxes = chain(3);
  const CollisionFilter none(std::vector<BodyGroups>(3), LayerMatrix());
  EXPECT_EQ(oracle.pairs(boxes).size(), 2U);
  EXPECT_EQ(oracle.pairs(boxes, none).size(), 0U);
  EXPECT_EQ(oracle.pairs(boxes, {}, {{0, 0, 0}, {1, 1, 1}}).size(), 3U) << "in a periodic world";
  EXPECT_EQ(oracle.pairDigest(boxes, none).count, 0U);
  EXPECT_EQ(oracle.pairDigest(boxes).count, 2U);
}

// The filter of the frame counts, not the initial one.
TEST(Oracle, IsAskedWithTheFilterOfTheFrame) {
  const std::vector<std::vector<Aabb>> boxes(4, chain(3));
  const std::vector<std::uint32_t> one = {1};
  const CollisionFilter first(std::vector<BodyGroups>(3), LayerMatrix().set(0, 0), true);
  const CollisionFilter apart = first.with(one, std::vector{BodyGroups{.layer = 1}}, 3);
  FrameList frames = listed(sceneOf(boxes), boxes, {first, first, apart, first});
  for (const AnswerKind answer : {AnswerKind::pairs, AnswerKind::events}) {
    for (const std::string id : {"bf", "tide"}) {
      Case test_case{.algorithm = algorithmOf(id)};
      test_case.answer = answer;
      const CaseResult result = runCase(test_case, frames);
      EXPECT_EQ(result.status, Status::ok) << id << result.reason;
    }
  }
}

// Pairs of absent bodies, and filtered pairs, are wrong.
TEST(Difference, CallsPairsFalseThatAreNotWanted) {
  std::vector<Aabb> boxes = chain(4);
  boxes[3] = kEmptyBox;
  const std::vector<BodyGroups> bodies = {{.layer = 1}, {.layer = 1}, {}, {}};
  const CollisionFilter filter(bodies, LayerMatrix().set(0, 1));
  const std::vector<Pair> answer = {{0, 1}, {1, 2}, {2, 3}};
  const PairRun span = answer;
  const FrameDifference difference = findDifference({&span, 1}, bruteForcePairs(boxes, filter),
                                                    {.index = 1, .boxes = boxes}, 10, filter);
  EXPECT_EQ(difference.false_count, 2U);
  EXPECT_EQ(difference.missed_count + difference.allowed_extra_count, 0U);
}

TEST(Difference, NothingWhenAllIsRight) {
  const std::vector<Aabb> boxes = chain(4);
  const FrameDifference difference = compare({{2, 3}, {0, 1}, {1, 2}}, boxes);
  EXPECT_FALSE(difference.isMismatch());
  EXPECT_EQ(difference.allowed_extra_count, 0U);
  EXPECT_EQ(difference.frame, 7U);
}

TEST(Difference, ListsMissedAndFalsePairs) {
  const FrameDifference difference = compare({{0, 3}, {1, 2}}, chain(4));
  EXPECT_THAT(difference.missed_pairs, ElementsAre(Pair{0, 1}, Pair{2, 3}));
  EXPECT_THAT(difference.false_pairs, ElementsAre(Pair{0, 3}));
  EXPECT_EQ(difference.missed_count, 2U);
  EXPECT_EQ(difference.false_count, 1U);
  EXPECT_EQ(difference.allowed_extra_count, 0U);
  EXPECT_TRUE(difference.isMismatch());
}

TEST(Difference, MissingEverythingIsSeen) { EXPECT_EQ(compare({}, chain(4)).missed_count, 3U); }

TEST(Difference, ExtraPairsAreAllowedWithinTheMarginOnly) {
  // The gaps between boxes 0, 1 and 2 are 0.2 and 1.
  const std::vector<Aabb> boxes = {unitBox(0), unitBox(1.2F), unitBox(3.2F)};
  const FrameDifference near = compare({{0, 1}}, boxes, 0.125F);
  EXPECT_THAT(near.allowed_extra_pairs, ElementsAre(Pair{0, 1}));
  EXPECT_EQ(near.allowed_extra_count, 1U);
  EXPECT_EQ(near.false_count, 0U);
  EXPECT_FALSE(near.isMismatch());

  const FrameDifference far = compare({{0, 1}, {1, 2}}, boxes, 0.125F);
  EXPECT_THAT(far.allowed_extra_pairs, ElementsAre(Pair{0, 1}));
  EXPECT_THAT(far.false_pairs, ElementsAre(Pair{1, 2}));
  EXPECT_TRUE(far.isMismatch());
  EXPECT_TRUE(compare({{0, 1}}, boxes, 0.0625F).isMismatch());
}

TEST(Difference, PairsThatAreNoneAreInvalid) {
  const std::vector<Aabb> boxes = chain(2);
  const std::vector<Pair> invalid = {{1, 1}, {1, 0}, {0, 2}, {5, 9}, {0, 0xFFFFFFFF}};
  for (const Pair pair : invalid) {
    const FrameDifference difference = compare({{0, 1}, pair}, boxes);
    EXPECT_EQ(difference.invalid_count, 1U);
    EXPECT_THAT(difference.invalid_pairs, ElementsAre(pair));
    EXPECT_EQ(difference.missed_count + difference.false_count, 0U);
    EXPECT_TRUE(difference.isMismatch());
  }
}

TEST(Difference, DuplicatesAreInvalidWhetherRightOrWrong) {
  const FrameDifference right = compare({{0, 1}, {1, 2}, {0, 1}, {0, 1}}, chain(3));
  EXPECT_THAT(right.invalid_pairs, ElementsAre(Pair{0, 1}, Pair{0, 1}));
  EXPECT_EQ(right.missed_count + right.false_count, 0U);

  const FrameDifference wrong = compare({{0, 1}, {1, 2}, {0, 2}, {0, 2}}, chain(3));
  EXPECT_EQ(wrong.false_count, 1U);
  EXPECT_EQ(wrong.invalid_count, 1U);
}

TEST(Difference, CountsAllAndListsTheFirstThousand) {
  constexpr std::uint32_t kBodies = 1600;
  const FrameDifference missed = compare({}, chain(kBodies));
  EXPECT_EQ(missed.missed_count, kBodies - 1U);
  ASSERT_EQ(missed.missed_pairs.size(), FrameDifference::kMaxListed);
  EXPECT_EQ(missed.missed_pairs.back(), (Pair{999, 1000}));

  std::vector<Aabb> apart = chain(kBodies);
  for (std::size_t i = 0; i < apart.size(); ++i) apart[i] = unitBox(2 * static_cast<float>(i));
  std::vector<Pair> answer;
  for (std::uint32_t i = 0; i + 1 < kBodies; ++i) {
    answer.push_back({i, i + 1});
    answer.push_back({i, i});
  }
  const FrameDifference false_pairs = compare(answer, apart);
  EXPECT_EQ(false_pairs.false_count, kBodies - 1U);
  EXPECT_EQ(false_pairs.invalid_count, kBodies - 1U);
  EXPECT_EQ(false_pairs.false_pairs.size(), FrameDifference::kMaxListed);
  EXPECT_EQ(false_pairs.invalid_pairs.size(), FrameDifference::kMaxListed);
}

}  // namespace
}  // namespace broadmark::tests
