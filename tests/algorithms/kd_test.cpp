// The adaptive KD tree: correctness for all kinds of motion, and the work per frame.

#include <gtest/gtest.h>

#include <string>

#include "algorithms/runs.h"
#include "support/changing_worlds.h"

namespace broadmark::tests {
namespace {

using Frames = std::vector<std::vector<Aabb>>;
using inputs::Random;
using inputs::Vec3;

ParameterValues leaf(int objects) { return {{"objects_per_leaf", std::to_string(objects)}}; }

/// The number of changes to the tree.
std::uint64_t structuralWork(const BroadPhase& broad_phase) {
  auto counters = countersOf(broad_phase);
  return counters.at("moves between nodes") + counters.at("trims") + counters.at("translations") +
         counters.at("erasures") + counters.at("partitions");
}

/// Steps through the frames, checks tree and answer, and calls inspect(broad phase, frame number).
template <class Inspect>
void replay(const std::string& id, int threads, const ParameterValues& parameters,
            const Frames& frames, Inspect inspect, AnswerKind answer = AnswerKind::pairs) {
  const Configuration config = {bestIsa(), threads, answer};
  SCOPED_TRACE(describe(algorithmOf(id), config));
  TestRun run(algorithmOf(id), config, parameters);
  run.start(sceneOf(frames), frames[0]);
  ASSERT_EQ(run.broadPhase().validate(), "") << "in the initial pose";
  for (std::size_t i = 1; i < frames.size(); ++i) {
    ASSERT_EQ(sorted(run.step(frames[i])), rightPairs(frames[i])) << "in frame " << i;
    ASSERT_EQ(run.broadPhase().validate(), "") << "in frame " << i;
    inspect(run.broadPhase(), i);
  }
}

void replay(const ParameterValues& parameters, const Frames& frames) {
  const auto nothing = [](const BroadPhase&, std::size_t) {};
  replay("kd", 1, parameters, frames, nothing);
  replay("kd-mt", 3, parameters, frames, nothing);
  replay("kd-mt", 2, parameters, frames, nothing, AnswerKind::events);
}

void shift(Aabb& box, const Vec3& offset) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.min[axis] += offset[axis];
    box.max[axis] += offset[axis];
  }
}

Vec3 randomOffset(Random& random, float max) {
  return {random.uniform(-max, max), random.uniform(-max, max), random.uniform(-max, max)};
}

/// Frames in which the bodies with moves(body, frame) take a random step of up to `max`.
template <class Moves>
Frames randomSteps(std::vector<Aabb> boxes, std::uint32_t count, float max, Moves moves) {
  Frames frames = {boxes};
  for (std::uint32_t frame = 1; frame < count; ++frame) {
    Random random(17, frame);
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      if (moves(i, frame)) shift(boxes[i], randomOffset(random, max));
    }
    frames.push_back(boxes);
  }
  return frames;
}

// The original retains the pairs of unchanged bodies without ever having searched for them.
TEST(Kd, FindsPairsOfASceneThatNeverMoves) {
  const Frames frames(5, inputs::clustered(3000, 0, 1));
  for (const std::string id : {"kd", "kd-mt"}) {
    replay(id, id == "kd" ? 1 : 2, leaf(50), frames,
           [&](const BroadPhase& broad_phase, std::size_t frame) {
             EXPECT_EQ(structuralWork(broad_phase), 0U) << "in frame " << frame;
             auto counters = countersOf(broad_phase);
             EXPECT_EQ(counters.at("moves"), 0U);
             // All pairs are searched for in the first frame, none afterwards.
             const std::uint64_t right = rightPairs(frames[0]).size();
             EXPECT_EQ(counters.at("pairs retained"), frame == 1 ? 0 : right);
             EXPECT_EQ(counters.at("subtrees skipped in searches"), frame == 1 ? 0U : 1U);
             EXPECT_EQ(counters.at("boxes tested") == 0, frame > 1);
           });
  }
}

TEST(Kd, StaysIncrementalWhereLittleMoves) {
  // Only the bodies in one corner move.
  const std::vector<Aabb> start = inputs::uniform(4000, 0, 1);
  const Frames frames = randomSteps(start, 20, 0.2F, [&](std::size_t i, std::uint32_t) {
    return std::max({start[i].min[0], start[i].min[1], start[i].min[2]}) < 8;
  });
  for (const std::string id : {"kd", "kd-mt"}) {
    replay(id, id == "kd" ? 1 : 2, leaf(50), frames,
           [](const BroadPhase& broad_phase, std::size_t frame) {
             if (frame == 1) return;
             auto counters = countersOf(broad_phase);
             EXPECT_GT(counters.at("moves"), 10U);
             EXPECT_LT(counters.at("moves"), 200U);
             EXPECT_LT(counters.at("moves between nodes"), 200U);
             EXPECT_GT(counters.at("pairs retained"), 500U);
             EXPECT_GT(counters.at("subtrees skipped in updates"), 3U);
             EXPECT_GT(counters.at("subtrees skipped in searches"), 3U);
           });
  }
}

// Few bodies move in static geometry: pairs within the geometry are never searched for, and moving
// bodies test only what is around them.
TEST(Kd, SearchesOnlyAroundMoversInStaticGeometry) {
  constexpr std::uint32_t kStatic = 20'000;
  constexpr std::uint32_t kMovers = 50;
  const std::vector<Aabb> start = inputs::uniform(kStatic + kMovers, 0, 1);
  Frames frames = randomSteps(start, 8, 0.2F, [](std::size_t i, std::uint32_t frame) {
    return i >= kStatic && frame != 5;
  });
  const CollisionFilter filter =
      filterOf(kStatic + kMovers, LayerMatrix().set(0, 1).set(1, 1),
               [](inputs::Random&, std::uint32_t body) {
                 return BodyGroups{.layer = std::uint8_t{body >= kStatic}};
               });
  SceneInfo scene = sceneOf(frames);
  scene.filter = filter;
  for (const int threads : {1, 3}) {
    TestRun run(algorithmOf(threads == 1 ? "kd" : "kd-mt"), {bestIsa(), threads});
    run.start(scene, frames[0]);
    for (std::uint32_t i = 1; i < frames.size(); ++i) {
      std::vector<Pair> right = sweptPairs(frames[i]);
      std::erase_if(right, [&](Pair pair) { return !filter.wanted(pair.a, pair.b); });
      ASSERT_EQ(sorted(run.step(frames[i])), right) << "in frame " << i;
      ASSERT_EQ(run.broadPhase().validate(), "") << "in frame " << i;
      auto counters = countersOf(run.broadPhase());
      EXPECT_EQ(counters.at("bodies at rest"), kStatic);
      EXPECT_EQ(counters.at("moves"), i == 5 ? 0 : kMovers);
      EXPECT_LT(counters.at("boxes tested"), i == 5 ? 1 : 500 * kMovers) << "in frame " << i;
      EXPECT_EQ(counters.at("partitions"), 0U);
    }
  }
}

TEST(Kd, HalfOfTheBodiesAreUnchanged) {
  for (const std::size_t movers : {499, 500, 501}) {
    replay(leaf(20), randomSteps(inputs::clustered(1000, 0, 1), 12, 0.3F,
                                 [&](std::size_t i, std::uint32_t) { return i < movers; }));
  }
}

// From no moving bodies to all and back: pairs are retained, dropped and found again.
TEST(Kd, BodiesWakeAndFallAsleep) {
  replay(leaf(20), randomSteps(inputs::clustered(1000, 0, 2), 60, 0.3F,
                               [](std::size_t i, std::uint32_t frame) {
                                 const std::uint32_t part = frame % 12;
                                 return part >= 4 && i % 16 < (part - 4) * (part - 4);
                               }));
}

TEST(Kd, BodiesMigrateAcrossManyNodes) {
  std::vector<Aabb> boxes = inputs::uniform(2000, 0, 3);
  Frames frames = {boxes};
  for (std::uint32_t frame = 1; frame < 15; ++frame) {
    // A few bodies, or most of them, swap their positions.
    Random random(3, frame);
    for (int exchange = 0; exchange < (frame % 5 == 0 ? 1500 : 100); ++exchange) {
      std::swap(boxes[static_cast<std::size_t>(random.integer(0, 1999))],
                boxes[static_cast<std::size_t>(random.integer(0, 1999))]);
    }
    frames.push_back(boxes);
  }
  replay(leaf(20), frames);
}

TEST(Kd, FollowsAStreamThroughSpace) {
  // All bodies drift along x at different speeds: planes have to move and nodes to be erased.
  const std::vector<Aabb> start = inputs::uniform(1500, 0, 4);
  Frames frames = {start};
  for (std::uint32_t frame = 1; frame < 80; ++frame) {
    frames.push_back(start);
    for (std::size_t i = 0; i < start.size(); ++i) {
      shift(frames.back()[i], {static_cast<float>(frame) * (i % 7 == 0 ? 2.0F : 0.5F), 0, 0});
    }
  }
  std::uint64_t translations = 0;
  std::uint64_t erasures = 0;
  std::uint64_t partitions = 0;
  replay("kd", 1, leaf(30), frames, [&](const BroadPhase& broad_phase, std::size_t) {
    auto counters = countersOf(broad_phase);
    translations += counters.at("translations");
    erasures += counters.at("erasures");
    partitions += counters.at("partitions");
  });
  EXPECT_GT(translations, 0U);
  EXPECT_GT(erasures, 0U);
  EXPECT_GT(partitions, 0U);
  replay(leaf(30), frames);
}

// A cluster jumps around among more bodies that do not move: nodes get new planes, and unchanged
// bodies have to change nodes.
TEST(Kd, RestructuresNodesAroundUnchangedBodies) {
  std::uint64_t translations = 0;
  std::uint64_t erasures = 0;
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    std::vector<Aabb> boxes = inputs::assorted(400, 0, seed);
    Frames frames = {boxes};
    for (std::uint32_t frame = 1; frame < 20; ++frame) {
      Random random(seed, frame);
      const Vec3 centre = random.inCube(inputs::cubeRoot(10.0 * 400));
      for (std::size_t i = 0; i < 190; ++i) {
        const Vec3 offset = randomOffset(random, 4);
        boxes[i] = inputs::boxAt(
            {centre[0] + offset[0], centre[1] + offset[1], centre[2] + offset[2]}, {1, 1, 1});
      }
      frames.push_back(boxes);
    }
    replay("kd", 1, leaf(5), frames, [&](const BroadPhase& broad_phase, std::size_t frame) {
      auto counters = countersOf(broad_phase);
      translations += frame > 1 ? counters.at("translations") : 0;
      erasures += frame > 1 ? counters.at("erasures") : 0;
    });
  }
  EXPECT_GT(translations, 0U);
  EXPECT_GT(erasures, 0U);
}

// All bodies collapse into a point, in which no plane separates them, and expand again.
TEST(Kd, CollapsesAndGrowsAgain) {
  const std::vector<Aabb> start = inputs::uniform(700, 0, 5);
  Frames frames = {start};
  for (const float share : {0.3F, 0.8F, 0.95F, 1.0F, 1.0F, 1.0F, 0.9F, 0.5F, 0.0F, 1.0F, 0.0F}) {
    frames.push_back(start);
    for (Aabb& box : frames.back()) {
      const Vec3 corner = {box.min[0], box.min[1], box.min[2]};
      box = inputs::boxAt(
          {corner[0] * (1 - share), corner[1] * (1 - share), corner[2] * (1 - share)}, {1, 1, 1});
    }
  }
  replay(leaf(20), frames);
  replay(leaf(1), frames);
}

// Outliers pull the mean away: without medians all other bodies would stay in one leaf.
TEST(Kd, SplitsInSpiteOfOutliers) {
  std::vector<Aabb> boxes = inputs::uniform(2000, 0, 6);
  for (std::size_t i = 0; i < 5; ++i) shift(boxes[i], {1e6F, 1e6F, 1e6F});
  const Frames frames = {boxes, boxes};
  replay("kd", 1, leaf(50), frames, [](const BroadPhase& broad_phase, std::size_t) {
    const RecordedDrawing drawing = drawingOf(broad_phase);
    int deepest = 0;
    for (const RecordedDrawing::Box& drawn : drawing.boxes()) {
      deepest = std::max(deepest, drawn.level);
    }
    EXPECT_GT(deepest, 4);
    EXPECT_EQ(populationOf(drawing) + countersOf(broad_phase).at("bodies at rest"), 2000U);
  });
}

// A thousand frames of small steps: errors would accumulate.
TEST(Kd, SurvivesAThousandFrames) {
  const Frames frames =
      randomSteps(inputs::clustered(300, 0, 7), 1001, 0.1F, [](std::size_t i, std::uint32_t frame) {
        // All bodies move, then a third, then none.
        return frame % 50 < 20 || (frame % 50 < 40 && i % 3 == 0);
      });
  replay(leaf(12), frames);
}

TEST(Kd, TwentyThousandBodies) {
  const auto all = [](std::size_t, std::uint32_t) { return true; };
  const auto few = [](std::size_t i, std::uint32_t) { return i % 20 == 0; };
  replay({}, randomSteps(inputs::uniform(20'000, 0, 8), 5, 0.2F, all));
  replay({}, randomSteps(inputs::uniform(20'000, 0, 8), 5, 0.2F, few));
  replay({}, randomSteps(inputs::clustered(20'000, 0, 8), 4, 0.2F, all));
}

// With a margin, bodies that jitter are unchanged; the answer remains exact.
TEST(Kd, IsExactWithAMargin) {
  const std::vector<Aabb> start = inputs::clustered(1000, 0, 9);
  Frames frames = {start};
  for (std::uint32_t frame = 1; frame < 20; ++frame) {
    Random random(9, frame);
    frames.push_back(start);
    for (Aabb& box : frames.back()) shift(box, randomOffset(random, 0.05F));
    // Some bodies leave their fat box, others shrink within it.
    for (std::size_t i = frame; i < start.size(); i += 37) {
      frames.back()[i] = inputs::boxAt(randomOffset(random, 5), {0.1F, 0.1F, 0.1F});
    }
  }
  for (const char* margin : {"0.01", "0.1", "3"}) {
    const ParameterValues parameters = {{"objects_per_leaf", "30"}, {"margin", margin}};
    replay(parameters, frames);
    replay(parameters, framesOf({"growing", inputs::growing}, 300, 5));
    replay(parameters, framesOf({"huge", inputs::huge}, 300, 3));
  }
  replay("kd", 1, {{"objects_per_leaf", "30"}, {"margin", "0.11"}}, frames,
         [](const BroadPhase& broad_phase, std::size_t frame) {
           EXPECT_LT(countersOf(broad_phase).at("moves"), 100U) << "in frame " << frame;
           EXPECT_EQ(broad_phase.margin(), 0);
         });
}

// Values that no recording contains: their sums and differences overflow.
TEST(Kd, SurvivesTheLimitsOfFloats) {
  replay(leaf(20), framesOf({"limits", inputs::limits}, 300, 4));
}

}  // namespace
}  // namespace broadmark::tests
