// Bullet's dynamic trees: no stale pairs, no extra pairs beyond the declared margin, and a margin
// for each instance, although Bullet's margin is global.

#include <gtest/gtest.h>

#include <map>
#include <thread>

#include "algorithms/runs.h"
#include "broadmark/exclusive_use.h"

namespace broadmark::tests {
namespace {

class Dbvt : public testing::TestWithParam<std::string> {
 protected:
  static TestRun start(const std::vector<Aabb>& first, const ParameterValues& values = {}) {
    TestRun test_run(algorithmOf(GetParam()), {}, values);
    test_run.start(first);
    return test_run;
  }

  static std::vector<Pair> step(TestRun& test_run, const std::vector<Aabb>& boxes) {
    std::vector<Pair> answer = sorted(test_run.step(boxes));
    EXPECT_EQ(test_run.broadPhase().validate(), "");
    return answer;
  }
};

/// A unit cube that begins at x.
Aabb unitCubeAt(float x) { return inputs::boxAt({x, 0, 0}, {1, 1, 1}); }

constexpr Pair kPair = {0, 1};

TEST_P(Dbvt, DropsStalePairsAtOnce) {
  // More pairs than the tenth that Bullet would check in a frame.
  std::vector<Aabb> boxes = inputs::clustered(500, 0, 1);
  TestRun dbvt = start(boxes);
  EXPECT_EQ(step(dbvt, boxes), bruteForcePairs(boxes));
  for (std::size_t i = 0; i < boxes.size(); ++i) boxes[i] = unitCubeAt(static_cast<float>(10 * i));
  EXPECT_TRUE(step(dbvt, boxes).empty());
}

TEST_P(Dbvt, StalePairsDoNotPileUp) {
  const auto frames = framesOf({"drifting", inputs::drifting}, 500, 100);
  TestRun dbvt = start(frames[0]);
  for (const std::vector<Aabb>& boxes : frames) {
    const std::vector<Pair> found = step(dbvt, boxes);
    const PairRun pair_run = found;
    const auto difference =
        findDifference({&pair_run, 1}, bruteForcePairs(boxes), {0, boxes}, dbvt.margin());
    EXPECT_FALSE(difference.isMismatch());
    // The margin is about a twentieth of a box.
    EXPECT_LT(difference.allowed_extra_count, found.size() / 2);
  }
}

// A body moves forth, which enlarges its leaf, and back to the other end of the leaf.
TEST_P(Dbvt, ReachesAsFarAsItDeclaresAndNoFarther) {
  for (const auto& [gap, found] : {std::pair{0.085F, true}, std::pair{0.105F, false}}) {
    const Aabb other = unitCubeAt(0.995F + gap);
    TestRun dbvt = start({unitCubeAt(0), other});
    EXPECT_FLOAT_EQ(dbvt.margin(), 0.1F);
    step(dbvt, {unitCubeAt(0.04F), other});
    EXPECT_EQ(step(dbvt, {unitCubeAt(-0.005F), other}),
              found ? std::vector{kPair} : std::vector<Pair>());
  }
}

TEST_P(Dbvt, TakesItsMarginFromTheParameter) {
  const std::vector<Aabb> first = {unitCubeAt(0), unitCubeAt(1.5F)};
  const std::vector<Aabb> next = {unitCubeAt(0.1F), unitCubeAt(1.5F)};
  TestRun wide = start(first, {{"margin", "1"}});
  EXPECT_EQ(wide.margin(), 2);
  EXPECT_EQ(step(wide, next), std::vector{kPair});
  TestRun usual = start(first);
  EXPECT_TRUE(step(usual, next).empty());
}

/// Whether the run's answer for frame `index` is right and its trees are valid.
testing::AssertionResult stepIsRight(TestRun& test_run, std::uint32_t index,
                                     const std::vector<Aabb>& boxes) {
  auto right = isRight(test_run.step(boxes), rightPairs(boxes), {index, boxes}, test_run.margin());
  if (!right) return right << " in frame " << index << ", margin " << test_run.margin();
  const std::string fault = test_run.broadPhase().validate();
  if (fault.empty()) return testing::AssertionSuccess();
  return testing::AssertionFailure() << fault << " in frame " << index;
}

// Bullet's margin is global, yet each of two instances has its own: with the other's margin, the
// exact instance would have too large leaves, and the wide instance would reinsert as many bodies.
TEST_P(Dbvt, InstancesThatTakeTurnsKeepTheirMargins) {
  const auto frames = framesOf({"drifting", inputs::drifting}, 200, 30);
  TestRun wide = start(frames[0], {{"margin", "0.5"}});
  TestRun exact = start(frames[0], {{"margin", "0"}});
  std::uint64_t reinsertions_wide = 0;
  std::uint64_t reinsertions_exact = 0;
  for (std::uint32_t i = 1; i < frames.size(); ++i) {
    ASSERT_TRUE(stepIsRight(wide, i, frames[i]));
    ASSERT_TRUE(stepIsRight(exact, i, frames[i]));
    reinsertions_wide += countersOf(wide.broadPhase()).at("reinsertions");
    reinsertions_exact += countersOf(exact.broadPhase()).at("reinsertions");
  }
  EXPECT_LT(reinsertions_wide, reinsertions_exact / 2);
}

// For ThreadSanitizer: the host serialises the use of the margin.
TEST_P(Dbvt, RunsOnTwoThreadsKeepTheirMargins) {
  const auto frames = framesOf({"drifting", inputs::drifting}, 200, 30);
  const auto follow = [&](const char* margin) {
    TestRun test_run = start(frames[0], {{"margin", margin}});
    for (std::uint32_t i = 1; i < frames.size(); ++i) {
      ASSERT_TRUE(stepIsRight(test_run, i, frames[i]));
    }
  };
  std::thread other([&] { follow("0.5"); });
  follow("0");
  other.join();
}

TEST_P(Dbvt, NamesTheStateThatItUses) {
  EXPECT_EQ(algorithmOf(GetParam()).traits.exclusive, kBulletTreeMargin);
}

TEST_P(Dbvt, IsExactWithoutAMargin) {
  for (const inputs::Input& input : inputs::kAll) {
    const auto frames = framesOf(input, 200, 5);
    TestRun dbvt = start(frames[0], {{"margin", "0"}});
    EXPECT_EQ(dbvt.margin(), 0);
    for (const std::vector<Aabb>& boxes : frames) {
      EXPECT_EQ(step(dbvt, boxes), bruteForcePairs(boxes)) << input.name;
    }
  }
}

// Bullet retains a leaf while it contains the box, even if the box has become small.
TEST_P(Dbvt, LeavesShrinkWithTheirBoxes) {
  const Aabb other = unitCubeAt(3);
  TestRun dbvt = start({inputs::boxAt({0, 0, 0}, {4, 4, 4}), other});
  EXPECT_EQ(step(dbvt, {inputs::boxAt({0, 0, 0}, {3.5F, 4, 4}), other}), std::vector{kPair});
  EXPECT_TRUE(step(dbvt, {unitCubeAt(0), other}).empty());
}

TEST_P(Dbvt, WorksOnlyForWhatMoves) {
  std::vector<Aabb> boxes = inputs::uniform(1000, 0, 1);
  TestRun dbvt = start(boxes);
  for (int frame = 0; frame < 4; ++frame) {  // bodies move into the tree of resting bodies
    EXPECT_EQ(step(dbvt, boxes), bruteForcePairs(boxes));
    EXPECT_EQ(countersOf(dbvt.broadPhase()).at("moves"), 0U);
    EXPECT_EQ(countersOf(dbvt.broadPhase()).at("reinsertions"), 0U);
  }
  const auto move_body = [&](float x) {
    boxes[5] = unitCubeAt(x);
    step(dbvt, boxes);
    EXPECT_EQ(countersOf(dbvt.broadPhase()).at("moves"), 1U);
    return countersOf(dbvt.broadPhase()).at("reinsertions");
  };
  EXPECT_EQ(move_body(1), 1U);      // leaves that tree
  EXPECT_EQ(move_body(1.5F), 1U);   // leaves its leaf
  EXPECT_EQ(move_body(1.51F), 0U);  // stays in its leaf
}

TEST_P(Dbvt, DrawsBothTrees) {
  constexpr std::size_t kMoving = 30;
  constexpr std::size_t kResting = 70;
  std::vector<Aabb> boxes = inputs::uniform(kMoving + kResting, 0, 1);
  TestRun dbvt = start(boxes);
  for (int frame = 1; frame < 5; ++frame) {
    for (std::size_t i = 0; i < kMoving; ++i) boxes[i] = inputs::uniform(100, frame, 1)[i];
    step(dbvt, boxes);
  }
  std::map<StructureRole, std::size_t> nodes;
  int roots = 0;
  const RecordedDrawing drawing = drawingOf(dbvt.broadPhase());
  for (const RecordedDrawing::Box& drawn : drawing.boxes()) {
    ++nodes[drawn.role];
    if (drawn.level == 0) ++roots;
  }
  EXPECT_EQ(roots, 2);
  std::vector<std::size_t> counts;
  for (const auto& [colour, count] : nodes) counts.push_back(count);
  std::ranges::sort(counts);
  EXPECT_EQ(counts, (std::vector<std::size_t>{2 * kMoving - 1, 2 * kResting - 1}));
}

INSTANTIATE_TEST_SUITE_P(Bullet, Dbvt, testing::Values("dbvt-f", "dbvt-d"), [](const auto& tested) {
  return tested.param == "dbvt-f" ? "forward" : "deferred";
});

}  // namespace
}  // namespace broadmark::tests
