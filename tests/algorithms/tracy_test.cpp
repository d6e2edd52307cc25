// Tracy: incremental updates, and correctness for bodies that change cells, leave the world or
// touch very many cells.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>

#include "algorithms/runs.h"

namespace broadmark::tests {
namespace {

/// Runs Tracy twice, for pairs and for events, and checks structure and answers.
class CheckedRun {
 public:
  CheckedRun(const std::string& id, int threads, int objects_per_cell, const Aabb& world,
             const std::vector<Aabb>& first)
      : pairs_(algorithmOf(id), {Isa::scalar, threads},
               {{"objects_per_cell", std::to_string(objects_per_cell)}}),
        events_(algorithmOf(id), {Isa::scalar, threads, AnswerKind::events},
                {{"objects_per_cell", std::to_string(objects_per_cell)}}) {
    SceneInfo scene;
    scene.objects = static_cast<std::uint32_t>(first.size());
    scene.world = world;
    pairs_.start(scene, first);
    events_.start(scene, first);
  }

  void step(const std::vector<Aabb>& boxes) {
    ++index_;
    const std::vector<Pair> right = sweptPairs(boxes);
    EXPECT_EQ(sorted(pairs_.step(boxes)), right) << "in frame " << index_;
    EXPECT_EQ(sorted(events_.step(boxes)), right) << "from events, in frame " << index_;
    EXPECT_EQ(pairs_.broadPhase().validate(), "") << "in frame " << index_;
  }

  [[nodiscard]] Counters counters() { return countersOf(pairs_.broadPhase()); }
  [[nodiscard]] const BroadPhase& broadPhase() { return pairs_.broadPhase(); }

 private:
  TestRun pairs_;
  TestRun events_;
  std::uint32_t index_ = 0;
};

Aabb cubeFrom(float low, float high) { return {{low, low, low, 0}, {high, high, high, 0}}; }

void moveBy(Aabb& box, const inputs::Vec3& offset) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.min[axis] += offset[axis];
    box.max[axis] += offset[axis];
  }
}

inputs::Vec3 randomOffset(inputs::Random& random, float max) {
  return {random.uniform(-max, max), random.uniform(-max, max), random.uniform(-max, max)};
}

TEST(Tracy, DoesNothingWhenNothingMoves) {
  const std::vector<Aabb> boxes = inputs::assorted(2000, 0, 5);
  CheckedRun tracy("tracy", 1, 20, cubeFrom(0, 30), boxes);
  tracy.step(boxes);
  for (const auto& [name, count] : tracy.counters()) EXPECT_EQ(count, 0U) << name;

  std::vector<Aabb> with_move = boxes;
  moveBy(with_move[77], {0.1F, 0, 0});
  tracy.step(with_move);
  EXPECT_GE(tracy.counters()["moves"], 1U);
  EXPECT_LE(tracy.counters()["moves"], 8U);
  EXPECT_GT(tracy.counters()["swaps"], 0U);
  EXPECT_LT(tracy.counters()["swaps"], 200U);
}

TEST(Tracy, IsExactOverAThousandFramesOfSmallMoves) {
  for (const char* id : {"tracy", "tracy-mt"}) {
    std::vector<Aabb> boxes = inputs::clustered(400, 0, 9);
    CheckedRun tracy(id, id == std::string("tracy") ? 1 : 3, 25, cubeFrom(-6, 6), boxes);
    Counters sum;
    for (std::uint32_t frame = 1; frame <= 1000; ++frame) {
      inputs::Random random(4, frame);
      for (std::size_t i = frame % 3; i < boxes.size(); i += 3) {
        // On a coarse lattice, so that many bounds are equal.
        inputs::Vec3 offset = randomOffset(random, 0.3F);
        for (float& x : offset) x = std::round(x * 8) / 8;
        moveBy(boxes[i], offset);
      }
      tracy.step(boxes);
      if (HasFailure()) return;
      for (const auto& [name, count] : tracy.counters()) sum[name] += count;
    }
    for (const char* name : {"moves", "swaps", "cell changes", "pairs begun", "pairs ended"}) {
      EXPECT_GT(sum[name], 1000U) << name;
    }
    EXPECT_EQ(sum["grid rebuilds"], 0U);
  }
}

TEST(Tracy, IsExactForManyBodies) {
  constexpr std::size_t kCount = 20'000;
  std::vector<Aabb> boxes = inputs::assorted(kCount, 0, 2);
  CheckedRun single("tracy", 1, 200, cubeFrom(0, 58.5F), boxes);
  CheckedRun parallel("tracy-mt", 4, 200, cubeFrom(0, 58.5F), boxes);
  for (std::uint32_t frame = 1; frame <= 5; ++frame) {
    inputs::Random random(8, frame);
    for (Aabb& box : boxes) moveBy(box, randomOffset(random, 0.4F));
    for (std::size_t i = 0; i < 100; ++i) moveBy(boxes[i * 191], randomOffset(random, 60));
    single.step(boxes);
    parallel.step(boxes);
  }
}

// The tests of all algorithms use the default cells; with small cells most bodies cross boundaries.
TEST(Tracy, IsExactWithCellsOfAFewBodies) {
  constexpr std::size_t kCount = 257;
  constexpr std::uint32_t kSteps = 4;
  for (const int objects_per_cell : {1, 4}) {
    std::vector<std::vector<Aabb>> unrelated;
    for (const inputs::Input& input : inputs::kAll) {
      SCOPED_TRACE(input.name);
      const auto frames = framesOf(input, kCount, kSteps);
      CheckedRun tracy("tracy-mt", 2, objects_per_cell, sceneOf(frames).world, frames[0]);
      for (std::uint32_t i = 1; i < kSteps; ++i) tracy.step(frames[i]);
      unrelated.push_back(frames[1]);
      if (HasFailure()) return;
    }
    CheckedRun tracy("tracy", 1, objects_per_cell, cubeFrom(-10, 20), unrelated[0]);
    for (const std::vector<Aabb>& boxes : unrelated) tracy.step(boxes);
  }
}

// So few movers that cells look up each of them: they take small steps, jump, vanish and reappear.
TEST(Tracy, FindsFewMoversAmongMany) {
  constexpr std::size_t kCount = 1000;
  constexpr std::size_t kMovers = 12;
  constexpr float kEdge = 12;
  for (const int threads : {1, 2, 3}) {
    SCOPED_TRACE(threads);
    std::vector<Aabb> boxes = inputs::assorted(kCount, 0, 5);
    CheckedRun tracy(threads > 1 ? "tracy-mt" : "tracy", threads, 4, cubeFrom(0, kEdge), boxes);
    inputs::Random random(3, 1);
    const auto random_body = [&] {
      return static_cast<std::size_t>(random.uniform(0, kCount - 0.5F));
    };
    for (int frame = 0; frame < 60; ++frame) {
      for (std::size_t i = 0; i < kMovers; ++i) {
        Aabb& box = boxes[i % 2 == 0 ? i : random_body()];
        const float choice = random.uniform(0, 1);
        if (isEmpty(box)) {
          box = boxes[kCount - 1 - i];  // identical to another body, unless that is absent
        } else if (choice < 0.2F) {
          box = kEmptyBox;
        } else {
          moveBy(box, randomOffset(random, choice < 0.4F ? kEdge : 0.3F));
        }
      }
      tracy.step(boxes);
      if (HasFailure()) return;
    }
  }
}

// The intersection moves from cell to cell, but the pair neither begins nor ends.
TEST(Tracy, KeepsPairsThatChangeCells) {
  std::vector<Aabb> boxes(8, cubeFrom(0, 0.4F));
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) moveBy(boxes[i], {static_cast<float>(i) * 0.02F, 0, 0});
  }
  CheckedRun tracy("tracy", 1, 1, cubeFrom(0, 4), boxes);
  std::uint64_t cell_changes = 0;
  for (int frame = 0; frame < 100; ++frame) {
    const float step = frame < 50 ? 0.09F : -0.09F;
    for (Aabb& box : boxes) moveBy(box, {step, step / 2, -step / 3});
    tracy.step(boxes);
    const Counters counters = tracy.counters();
    cell_changes += counters.at("cell changes");
    EXPECT_EQ(counters.at("pairs begun") + counters.at("pairs ended"), 0U);
  }
  EXPECT_GT(cell_changes, 16U);
}

// Two bodies move in the same direction by more than their distance: their endpoints are swapped
// and swapped back within a frame.
TEST(Tracy, ReportsNothingThatIsUndoneWithinAFrame) {
  std::vector<Aabb> boxes = {cubeFrom(0, 1), cubeFrom(1.5F, 2.5F)};
  CheckedRun tracy("tracy", 1, 200, cubeFrom(0, 100), boxes);
  for (int frame = 0; frame < 40; ++frame) {
    for (Aabb& box : boxes) moveBy(box, {2, 2, 2});
    tracy.step(boxes);
    EXPECT_EQ(tracy.counters()["pairs begun"], 0U);
  }
}

TEST(Tracy, ReinsertsBodiesThatMoveFarWithinACell) {
  std::vector<Aabb> boxes = inputs::uniform(600, 0, 6);
  CheckedRun tracy("tracy", 1, 1'000'000, cubeFrom(0, 18), boxes);
  const std::vector<Aabb> elsewhere = inputs::uniform(600, 1, 6);
  std::copy_n(elsewhere.begin(), 300, boxes.begin());
  tracy.step(boxes);
  EXPECT_GT(tracy.counters()["jumps"], 200U);
  tracy.step(inputs::teleporting(600, 1, 1));
  tracy.step(inputs::identical(600, 2, 1));
  tracy.step(boxes);
}

TEST(Tracy, IsExactOutsideOfTheWorld) {
  std::vector<Aabb> boxes = inputs::clustered(500, 0, 3);
  CheckedRun tracy("tracy-mt", 2, 20, cubeFrom(-4, 4), boxes);
  for (std::uint32_t frame = 1; frame <= 60; ++frame) {
    inputs::Random random(5, frame);
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      // Most bodies drift out of the world, close enough to each other to collide.
      moveBy(boxes[i], randomOffset(random, 0.2F));
      if (i % 3 != 0) moveBy(boxes[i], {0.5F, -0.5F, i % 2 == 0 ? 0.5F : 0.0F});
    }
    tracy.step(boxes);
  }
  tracy.step(inputs::scaled(boxes, 1e30F));
  tracy.step(boxes);
}

// The world is a point or a plane.
TEST(Tracy, IsExactInADegenerateWorld) {
  for (const Aabb& world : {cubeFrom(0, 0), cubeFrom(3, 3), Aabb{{0, 0, 0, 0}, {10, 10, 0, 0}}}) {
    CheckedRun tracy("tracy", 1, 5, world, inputs::uniform(300, 0, 1));
    for (std::uint32_t frame = 1; frame < 4; ++frame) tracy.step(inputs::uniform(300, frame, 1));
  }
}

// Values that no recording contains: differences overflow.
TEST(Tracy, SurvivesTheLimitsOfFloats) {
  const std::vector<Aabb> first = inputs::limits(300, 0, 1);
  for (const Aabb& world : {cubeFrom(-1, 1), cubeFrom(-std::numeric_limits<float>::max(),
                                                      std::numeric_limits<float>::max())}) {
    CheckedRun tracy("tracy", 1, 5, world, first);
    for (std::uint32_t frame = 1; frame < 5; ++frame) tracy.step(inputs::limits(300, frame, 1));
  }
}

// On the initial grid the bodies would touch a thousand cells each.
TEST(Tracy, CoarsensTheGridForBodiesThatTouchManyCells) {
  const std::vector<Aabb> small = inputs::uniform(1000, 0, 4);
  std::vector<Aabb> large = small;
  for (std::size_t i = 0; i < large.size(); ++i) {
    large[i].min[i % 3] = -1;
    large[i].max[i % 3] = 30;
    large[i].min[(i + 1) % 3] = -1;
    large[i].max[(i + 1) % 3] = 30;
  }
  for (const char* id : {"tracy", "tracy-mt"}) {
    CheckedRun tracy(id, id == std::string("tracy") ? 1 : 3, 1, cubeFrom(0, 21.5F), small);
    tracy.step(large);
    EXPECT_EQ(tracy.counters()["grid rebuilds"], 1U);
    tracy.step(large);
    EXPECT_EQ(tracy.counters()["grid rebuilds"], 0U);
    // The grid is refined step by step, up to the initial grid.
    std::uint64_t rebuilds = 0;
    std::vector<Aabb> boxes = small;
    for (int frame = 0; frame < 12; ++frame) {
      moveBy(boxes[0], {0.01F, 0, 0});
      tracy.step(boxes);
      rebuilds += tracy.counters()["grid rebuilds"];
    }
    EXPECT_GE(rebuilds, 2U);
    EXPECT_EQ(tracy.counters()["grid rebuilds"], 0U);
    CheckedRun fresh(id, 1, 1, cubeFrom(0, 21.5F), small);
    fresh.step(boxes);
    tracy.step(boxes);
  }
}

// A floor and four walls among small bodies do not coarsen the grid.
TEST(Tracy, KeepsTheGridForAFewLargeBodies) {
  std::vector<Aabb> boxes = inputs::uniform(2000, 0, 4);
  for (std::size_t i = 0; i < 5; ++i) boxes[i] = cubeFrom(-1, 30);
  CheckedRun tracy("tracy", 1, 10, cubeFrom(0, 28), boxes);
  for (Aabb& box : boxes) moveBy(box, {0.1F, 0.2F, 0});
  tracy.step(boxes);
  EXPECT_EQ(tracy.counters()["grid rebuilds"], 0U);
}

TEST(Tracy, DrawsOccupiedCellsAndTheirSegments) {
  std::vector<Aabb> boxes(100, cubeFrom(0.1F, 0.2F));
  for (std::size_t i = 0; i < 50; ++i) boxes[i] = cubeFrom(3.5F, 3.6F);
  CheckedRun tracy("tracy", 1, 1, cubeFrom(0, 4), boxes);
  std::map<int, std::vector<Aabb>> levels;
  const RecordedDrawing drawing = drawingOf(tracy.broadPhase());
  for (const RecordedDrawing::Box& drawn : drawing.boxes()) {
    levels[drawn.level].push_back(drawn.box);
    EXPECT_EQ(drawn.population, drawn.level == 0 ? 50U : 0U);
  }
  ASSERT_EQ(levels[0].size(), 2U);
  EXPECT_EQ(levels[0][0].min, cubeFrom(0, 0).min);
  EXPECT_EQ(levels[0][1].max, cubeFrom(4, 4).max);
  // 100 endpoints in each cell: three chunks, the first of which begins at the first endpoint.
  for (const Aabb& cell : levels[0]) {
    float covered = 0;
    for (const Aabb& segment : levels[1]) {
      if (overlaps(cell, segment)) covered += segment.max[0] - segment.min[0];
    }
    EXPECT_NEAR(covered, cell.max[0] - cell.min[0], 1e-5F);
  }
  EXPECT_GT(levels[1].size(), 4U);
}

}  // namespace
}  // namespace broadmark::tests
