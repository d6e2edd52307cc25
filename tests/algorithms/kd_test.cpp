// The adaptive KD tree: that it is right whatever moves, and that it does no more than it must.

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

/// All that an update may do to the tree.
std::uint64_t structuralWork(const BroadPhase& broad_phase) {
  auto counters = countersOf(broad_phase);
  return counters.at("moves between nodes") + counters.at("trims") + counters.at("translations") +
         counters.at("erasures") + counters.at("partitions");
}

/// Steps through the frames, checking tree and answer each time, and calls look(broad phase, frame
/// number) after each.
template <class Look>
void follow(const std::string& id, int threads, const ParameterValues& parameters,
            const Frames& frames, Look look, AnswerKind answer = AnswerKind::pairs) {
  const Configuration way = {bestIsa(), threads, answer};
  SCOPED_TRACE(describe(algorithmOf(id), way));
  TestRun run(algorithmOf(id), way, parameters);
  run.start(sceneOf(frames), frames[0]);
  ASSERT_EQ(run.broadPhase().validate(), "") << "at first";
  for (std::size_t i = 1; i < frames.size(); ++i) {
    ASSERT_EQ(sorted(run.step(frames[i])), rightPairs(frames[i])) << "in frame " << i;
    ASSERT_EQ(run.broadPhase().validate(), "") << "in frame " << i;
    look(run.broadPhase(), i);
  }
}

void follow(const ParameterValues& parameters, const Frames& frames) {
  const auto nothing = [](const BroadPhase&, std::size_t) {};
  follow("kd", 1, parameters, frames, nothing);
  follow("kd-mt", 3, parameters, frames, nothing);
  follow("kd-mt", 2, parameters, frames, nothing, AnswerKind::events);
}

void shift(Aabb& box, const Vec3& way) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.min[axis] += way[axis];
    box.max[axis] += way[axis];
  }
}

Vec3 randomWay(Random& random, float most) {
  return {random.uniform(-most, most), random.uniform(-most, most), random.uniform(-most, most)};
}

/// Frames in which the bodies for which moves(body, frame) take a random step of at most `most`.
template <class Moves>
Frames randomSteps(std::vector<Aabb> boxes, std::uint32_t count, float most, Moves moves) {
  Frames frames = {boxes};
  for (std::uint32_t frame = 1; frame < count; ++frame) {
    Random random(17, frame);
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      if (moves(i, frame)) shift(boxes[i], randomWay(random, most));
    }
    frames.push_back(boxes);
  }
  return frames;
}

// The original keeps the pairs of still bodies without ever having searched for them.
TEST(Kd, FindsPairsOfASceneThatNeverMoves) {
  const Frames frames(5, inputs::clustered(3000, 0, 1));
  for (const std::string id : {"kd", "kd-mt"}) {
    follow(id, id == "kd" ? 1 : 2, leaf(50), frames,
           [&](const BroadPhase& broad_phase, std::size_t frame) {
             EXPECT_EQ(structuralWork(broad_phase), 0U) << "in frame " << frame;
             auto counters = countersOf(broad_phase);
             EXPECT_EQ(counters.at("moved bodies"), 0U);
             // All pairs are searched for in the first frame, none afterwards.
             const std::uint64_t right = rightPairs(frames[0]).size();
             EXPECT_EQ(counters.at("pairs kept"), frame == 1 ? 0 : right);
             EXPECT_EQ(counters.at("subtrees skipped in searches"), frame == 1 ? 0U : 1U);
             EXPECT_EQ(counters.at("boxes looked at") == 0, frame > 1);
           });
  }
}

TEST(Kd, StaysIncrementalWhereLittleMoves) {
  // The bodies of one corner only.
  const std::vector<Aabb> start = inputs::uniform(4000, 0, 1);
  const Frames frames = randomSteps(start, 20, 0.2F, [&](std::size_t i, std::uint32_t) {
    return std::max({start[i].min[0], start[i].min[1], start[i].min[2]}) < 8;
  });
  for (const std::string id : {"kd", "kd-mt"}) {
    follow(id, id == "kd" ? 1 : 2, leaf(50), frames,
           [](const BroadPhase& broad_phase, std::size_t frame) {
             if (frame == 1) return;
             auto counters = countersOf(broad_phase);
             EXPECT_GT(counters.at("moved bodies"), 10U);
             EXPECT_LT(counters.at("moved bodies"), 200U);
             EXPECT_LT(counters.at("moves between nodes"), 200U);
             EXPECT_GT(counters.at("pairs kept"), 500U);
             EXPECT_GT(counters.at("subtrees skipped in updates"), 3U);
             EXPECT_GT(counters.at("subtrees skipped in searches"), 3U);
           });
  }
}

// Few move among very many that never do, and that do not meet each other: no pair of these is
// looked for, from the beginning on, and the others look at what is around them only.
TEST(Kd, LooksOnlyAroundWhatMovesInALevel) {
  constexpr std::uint32_t kLevel = 20'000;
  constexpr std::uint32_t kMovers = 50;
  const std::vector<Aabb> start = inputs::uniform(kLevel + kMovers, 0, 1);
  Frames frames = randomSteps(
      start, 8, 0.2F, [](std::size_t i, std::uint32_t frame) { return i >= kLevel && frame != 5; });
  const CollisionFilter filter = filterOf(
      kLevel + kMovers, LayerMatrix().set(0, 1).set(1, 1), [](inputs::Random&, std::uint32_t body) {
        return BodyGroups{.layer = std::uint8_t{body >= kLevel}};
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
      EXPECT_EQ(counters.at("bodies at rest"), kLevel);
      EXPECT_EQ(counters.at("moved bodies"), i == 5 ? 0 : kMovers);
      EXPECT_LT(counters.at("boxes looked at"), i == 5 ? 1 : 500 * kMovers) << "in frame " << i;
      EXPECT_EQ(counters.at("partitions"), 0U);
    }
  }
}

TEST(Kd, HalfOfTheBodiesAreStill) {
  for (const std::size_t movers : {499, 500, 501}) {
    follow(leaf(20), randomSteps(inputs::clustered(1000, 0, 1), 12, 0.3F,
                                 [&](std::size_t i, std::uint32_t) { return i < movers; }));
  }
}

// From still to all moving and back, some in between: pairs are kept, dropped and found again.
TEST(Kd, BodiesWakeAndFallAsleep) {
  follow(leaf(20), randomSteps(inputs::clustered(1000, 0, 2), 60, 0.3F,
                               [](std::size_t i, std::uint32_t frame) {
                                 const std::uint32_t part = frame % 12;
                                 return part >= 4 && i % 16 < (part - 4) * (part - 4);
                               }));
}

TEST(Kd, BodiesMigrateAcrossManyNodes) {
  std::vector<Aabb> boxes = inputs::uniform(2000, 0, 3);
  Frames frames = {boxes};
  for (std::uint32_t frame = 1; frame < 15; ++frame) {
    // Bodies change places, a few at a time or most of them.
    Random random(3, frame);
    for (int exchange = 0; exchange < (frame % 5 == 0 ? 1500 : 100); ++exchange) {
      std::swap(boxes[static_cast<std::size_t>(random.integer(0, 1999))],
                boxes[static_cast<std::size_t>(random.integer(0, 1999))]);
    }
    frames.push_back(boxes);
  }
  follow(leaf(20), frames);
}

TEST(Kd, FollowsAStreamThroughSpace) {
  // Everybody drifts along x, at different speeds: planes have to follow and nodes to go.
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
  follow("kd", 1, leaf(30), frames, [&](const BroadPhase& broad_phase, std::size_t) {
    auto counters = countersOf(broad_phase);
    translations += counters.at("translations");
    erasures += counters.at("erasures");
    partitions += counters.at("partitions");
  });
  EXPECT_GT(translations, 0U);
  EXPECT_GT(erasures, 0U);
  EXPECT_GT(partitions, 0U);
  follow(leaf(30), frames);
}

// A crowd jumps from place to place among more bodies that stand still: nodes get other planes and
// other bodies, and with them those that did not move have to go where they now belong.
TEST(Kd, RebuildsNodesAroundBodiesThatStandStill) {
  std::uint64_t translations = 0;
  std::uint64_t erasures = 0;
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    std::vector<Aabb> boxes = inputs::assorted(400, 0, seed);
    Frames frames = {boxes};
    for (std::uint32_t frame = 1; frame < 20; ++frame) {
      Random random(seed, frame);
      const Vec3 place = random.inCube(inputs::cubeRoot(10.0 * 400));
      for (std::size_t i = 0; i < 190; ++i) {
        const Vec3 apart = randomWay(random, 4);
        boxes[i] = inputs::boxAt({place[0] + apart[0], place[1] + apart[1], place[2] + apart[2]},
                                 {1, 1, 1});
      }
      frames.push_back(boxes);
    }
    follow("kd", 1, leaf(5), frames, [&](const BroadPhase& broad_phase, std::size_t frame) {
      auto counters = countersOf(broad_phase);
      translations += frame > 1 ? counters.at("translations") : 0;
      erasures += frame > 1 ? counters.at("erasures") : 0;
    });
  }
  EXPECT_GT(translations, 0U);
  EXPECT_GT(erasures, 0U);
}

// All bodies into one point, where no plane divides them, and back.
TEST(Kd, CollapsesAndGrowsAgain) {
  const std::vector<Aabb> start = inputs::uniform(700, 0, 5);
  Frames frames = {start};
  for (const float way : {0.3F, 0.8F, 0.95F, 1.0F, 1.0F, 1.0F, 0.9F, 0.5F, 0.0F, 1.0F, 0.0F}) {
    frames.push_back(start);
    for (Aabb& box : frames.back()) {
      const Vec3 corner = {box.min[0], box.min[1], box.min[2]};
      box = inputs::boxAt({corner[0] * (1 - way), corner[1] * (1 - way), corner[2] * (1 - way)},
                          {1, 1, 1});
    }
  }
  follow(leaf(20), frames);
  follow(leaf(1), frames);
}

// A few bodies far away draw the mean aside, and all others would stay in one leaf.
TEST(Kd, DividesBodiesInSpiteOfOutliers) {
  std::vector<Aabb> boxes = inputs::uniform(2000, 0, 6);
  for (std::size_t i = 0; i < 5; ++i) shift(boxes[i], {1e6F, 1e6F, 1e6F});
  const Frames frames = {boxes, boxes};
  follow("kd", 1, leaf(50), frames, [](const BroadPhase& broad_phase, std::size_t) {
    const RecordedDrawing drawing = drawingOf(broad_phase);
    int deepest = 0;
    for (const RecordedDrawing::Box& drawn : drawing.boxes()) {
      deepest = std::max(deepest, drawn.level);
    }
    EXPECT_GT(deepest, 4);
    EXPECT_EQ(populationOf(drawing) + countersOf(broad_phase).at("bodies at rest"), 2000U);
  });
}

// A thousand frames of small steps, in all instruction sets: any slip would add up.
TEST(Kd, SurvivesAThousandFrames) {
  const Frames frames =
      randomSteps(inputs::clustered(300, 0, 7), 1001, 0.1F, [](std::size_t i, std::uint32_t frame) {
        // In turn all, a third, and none.
        return frame % 50 < 20 || (frame % 50 < 40 && i % 3 == 0);
      });
  follow(leaf(12), frames);
}

TEST(Kd, TwentyThousandBodies) {
  const auto everybody = [](std::size_t, std::uint32_t) { return true; };
  const auto few = [](std::size_t i, std::uint32_t) { return i % 20 == 0; };
  follow({}, randomSteps(inputs::uniform(20'000, 0, 8), 5, 0.2F, everybody));
  follow({}, randomSteps(inputs::uniform(20'000, 0, 8), 5, 0.2F, few));
  follow({}, randomSteps(inputs::clustered(20'000, 0, 8), 4, 0.2F, everybody));
}

// With a margin bodies that jostle count as still, and the answer is still exact.
TEST(Kd, IsExactWithAMargin) {
  const std::vector<Aabb> start = inputs::clustered(1000, 0, 9);
  Frames frames = {start};
  for (std::uint32_t frame = 1; frame < 20; ++frame) {
    Random random(9, frame);
    frames.push_back(start);
    for (Aabb& box : frames.back()) shift(box, randomWay(random, 0.05F));
    // Some leave for good, some shrink to nothing within their stored box.
    for (std::size_t i = frame; i < start.size(); i += 37) {
      frames.back()[i] = inputs::boxAt(randomWay(random, 5), {0.1F, 0.1F, 0.1F});
    }
  }
  for (const char* margin : {"0.01", "0.1", "3"}) {
    const ParameterValues parameters = {{"objects_per_leaf", "30"}, {"margin", margin}};
    follow(parameters, frames);
    follow(parameters, framesOf({"growing", inputs::growing}, 300, 5));
    follow(parameters, framesOf({"huge", inputs::huge}, 300, 3));
  }
  follow("kd", 1, {{"objects_per_leaf", "30"}, {"margin", "0.11"}}, frames,
         [](const BroadPhase& broad_phase, std::size_t frame) {
           EXPECT_LT(countersOf(broad_phase).at("moved bodies"), 100U) << "in frame " << frame;
           EXPECT_EQ(broad_phase.margin(), 0);
         });
}

// Values no recording holds, whose sums and differences overflow.
TEST(Kd, SurvivesTheLimitsOfFloats) {
  follow(leaf(20), framesOf({"limits", inputs::limits}, 300, 4));
}

}  // namespace
}  // namespace broadmark::tests
