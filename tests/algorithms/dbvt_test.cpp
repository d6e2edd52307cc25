// Bullet's dynamic trees: no stale pairs, and no extra ones beyond the declared margin.

#include <gtest/gtest.h>

#include <array>

#include "algorithms/runs.h"

namespace broadmark::tests {
namespace {

class Dbvt : public testing::TestWithParam<std::string> {
 protected:
  std::unique_ptr<BroadPhase> start(const std::vector<Aabb>& first,
                                    const ParameterValues& values = {}) {
    std::unique_ptr<BroadPhase> dbvt = algorithmOf(GetParam()).create();
    setParameters(*dbvt, values);
    dbvt->initialize(sceneOf({first}), {0, first}, execution_);
    return dbvt;
  }

  static std::vector<Pair> step(BroadPhase& dbvt, const std::vector<Aabb>& boxes) {
    dbvt.updateObjects({1, boxes});
    dbvt.cleanCache();
    dbvt.updateStructures();
    dbvt.searchOverlaps();
    EXPECT_EQ(dbvt.validate(), "");
    return sorted(dbvt.overlaps());
  }

 private:
  Execution execution_{1, Isa::scalar};
};

/// A unit cube that begins at x.
Aabb cubeAt(float x) { return inputs::boxAt({x, 0, 0}, {1, 1, 1}); }

constexpr Pair kPair = {0, 1};

TEST_P(Dbvt, DropsStalePairsAtOnce) {
  // More pairs than a tenth, which is what Bullet would look through in one frame.
  std::vector<Aabb> boxes = inputs::clustered(500, 0, 1);
  const auto dbvt = start(boxes);
  EXPECT_EQ(step(*dbvt, boxes), bruteForcePairs(boxes));
  for (std::size_t i = 0; i < boxes.size(); ++i) boxes[i] = cubeAt(static_cast<float>(10 * i));
  EXPECT_TRUE(step(*dbvt, boxes).empty());
}

TEST_P(Dbvt, StalePairsDoNotPileUp) {
  const auto frames = framesOf({"drifting", inputs::drifting}, 500, 100);
  const auto dbvt = start(frames[0]);
  for (const std::vector<Aabb>& boxes : frames) {
    const std::vector<Pair> found = step(*dbvt, boxes);
    const PairRun run = found;
    const auto difference =
        findDifference({&run, 1}, bruteForcePairs(boxes), {0, boxes}, dbvt->capabilities().margin);
    EXPECT_FALSE(difference.isMismatch());
    // The margin is a twentieth of a box or so.
    EXPECT_LT(difference.extra_count, found.size() / 2);
  }
}

// Forth, which enlarges the leaf, and back to the other end of it.
TEST_P(Dbvt, ReachesAsFarAsItDeclaresAndNoFarther) {
  for (const auto& [gap, found] : {std::pair{0.085F, true}, std::pair{0.105F, false}}) {
    const Aabb other = cubeAt(0.995F + gap);
    const auto dbvt = start({cubeAt(0), other});
    EXPECT_FLOAT_EQ(dbvt->capabilities().margin, 0.1F);
    step(*dbvt, {cubeAt(0.04F), other});
    EXPECT_EQ(step(*dbvt, {cubeAt(-0.005F), other}),
              found ? std::vector{kPair} : std::vector<Pair>());
  }
}

TEST_P(Dbvt, TakesItsMarginFromTheParameter) {
  const std::vector<Aabb> first = {cubeAt(0), cubeAt(1.5F)};
  const std::vector<Aabb> next = {cubeAt(0.1F), cubeAt(1.5F)};
  {
    const auto wide = start(first, {{"margin", "1"}});
    EXPECT_EQ(wide->capabilities().margin, 2);
    EXPECT_EQ(step(*wide, next), std::vector{kPair});
  }
  // The margin belongs to the process: the next instance must not inherit it.
  EXPECT_TRUE(step(*start(first), next).empty());
  EXPECT_FALSE(start(first)->capabilities().exclusive.empty());
}

TEST_P(Dbvt, IsExactWithoutAMargin) {
  for (const inputs::Input& input : inputs::kAll) {
    const auto frames = framesOf(input, 200, 5);
    const auto dbvt = start(frames[0], {{"margin", "0"}});
    EXPECT_EQ(dbvt->capabilities().margin, 0);
    for (const std::vector<Aabb>& boxes : frames) {
      EXPECT_EQ(step(*dbvt, boxes), bruteForcePairs(boxes)) << input.name;
    }
  }
}

// Bullet keeps a leaf as long as it holds the box, however small that has become.
TEST_P(Dbvt, LeavesShrinkWithTheirBoxes) {
  const Aabb other = cubeAt(3);
  const auto dbvt = start({inputs::boxAt({0, 0, 0}, {4, 4, 4}), other});
  EXPECT_EQ(step(*dbvt, {inputs::boxAt({0, 0, 0}, {3.5F, 4, 4}), other}), std::vector{kPair});
  EXPECT_TRUE(step(*dbvt, {cubeAt(0), other}).empty());
}

TEST_P(Dbvt, WorksOnlyForWhatMoves) {
  std::vector<Aabb> boxes = inputs::uniform(1000, 0, 1);
  const auto dbvt = start(boxes);
  for (int frame = 0; frame < 4; ++frame) {  // into the tree of bodies at rest
    EXPECT_EQ(step(*dbvt, boxes), bruteForcePairs(boxes));
    EXPECT_EQ(countersOf(*dbvt).at("moves"), 0U);
    EXPECT_EQ(countersOf(*dbvt).at("reinsertions"), 0U);
  }
  const auto move_one = [&](float x) {
    boxes[5] = cubeAt(x);
    step(*dbvt, boxes);
    EXPECT_EQ(countersOf(*dbvt).at("moves"), 1U);
    return countersOf(*dbvt).at("reinsertions");
  };
  EXPECT_EQ(move_one(1), 1U);      // out of that tree
  EXPECT_EQ(move_one(1.5F), 1U);   // out of its leaf
  EXPECT_EQ(move_one(1.51F), 0U);  // about in its leaf
}

/// Counts nodes by colour.
class DrawnNodes final : public DebugDraw {
 public:
  void box(const Aabb&, Rgb colour, int level) override {
    ++count[colour];
    if (level == 0) ++roots;
  }
  void line(const std::array<float, 3>&, const std::array<float, 3>&, Rgb) override {}
  std::map<Rgb, std::size_t> count;
  int roots = 0;
};

TEST_P(Dbvt, DrawsBothTrees) {
  constexpr std::size_t kMoving = 30;
  constexpr std::size_t kResting = 70;
  std::vector<Aabb> boxes = inputs::uniform(kMoving + kResting, 0, 1);
  const auto dbvt = start(boxes);
  for (int frame = 1; frame < 5; ++frame) {
    for (std::size_t i = 0; i < kMoving; ++i) boxes[i] = inputs::uniform(100, frame, 1)[i];
    step(*dbvt, boxes);
  }
  DrawnNodes drawn;
  dbvt->drawStructure(drawn);
  EXPECT_EQ(drawn.roots, 2);
  std::vector<std::size_t> counts;
  for (const auto& [colour, count] : drawn.count) counts.push_back(count);
  std::ranges::sort(counts);
  EXPECT_EQ(counts, (std::vector<std::size_t>{2 * kMoving - 1, 2 * kResting - 1}));
}

INSTANTIATE_TEST_SUITE_P(Bullet, Dbvt, testing::Values("dbvt-f", "dbvt-d"), [](const auto& tested) {
  return tested.param == "dbvt-f" ? "forward" : "deferred";
});

}  // namespace
}  // namespace broadmark::tests
