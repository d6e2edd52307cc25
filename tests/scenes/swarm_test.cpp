// Swarm: cohesive moving flocks.

#include "scenes/scene_runs.h"

namespace broadmark::tests {
namespace {

/// The mean cosine between the headings of bodies at most `distance` apart.
double localOrder(const Boxes& before, const Boxes& after, double distance) {
  double sum = 0;
  int count = 0;
  for (std::size_t b = 0; b < after.size(); ++b) {
    for (std::size_t a = 0; a < b; ++a) {
      if (lengthOf(way(after[a], after[b])) > distance) continue;
      const Point p = way(before[a], after[a]);
      const Point q = way(before[b], after[b]);
      sum += dot(p, q) / (lengthOf(p) * lengthOf(q));
      ++count;
    }
  }
  EXPECT_GT(count, 0);
  return sum / std::max(count, 1);
}

TEST(SwarmScene, NeighboursComeToFlyTheSameWay) {
  auto simulation = sceneWith("swarm", {{"objects", "600"}, {"frames", "120"}, {"disorder", "1"}});
  const std::vector<Boxes> frames = allFrames(*simulation);
  const double at_first = localOrder(frames[0], frames[1], 4);
  const double in_the_end = localOrder(frames[119], frames[120], 4);
  EXPECT_LT(at_first, 0.8);
  EXPECT_GT(in_the_end, 0.75);
  EXPECT_GT(in_the_end, at_first + 0.1);
}

TEST(SwarmScene, StaysInTheWorldAndKeepsMoving) {
  auto simulation = sceneWith("swarm", {{"objects", "500"}, {"frames", "400"}});
  const std::vector<Boxes> frames = allFrames(*simulation);
  const Aabb& world = simulation->scene().world;
  for (const Boxes& boxes : frames) {
    // The initial flocks are inside the world, but may touch its walls.
    ASSERT_TRUE(allInside(boxes, world, 1));
  }
  for (std::size_t frame = 1; frame <= 400; ++frame) {
    ASSERT_TRUE(allInside(frames[frame], world, 1e-3)) << "frame " << frame;
  }
  double path = 0;
  for (std::size_t i = 0; i < 500; ++i) path += lengthOf(way(frames[399][i], frames[400][i])) / 500;
  EXPECT_NEAR(30 * path / (2.0 * world.max[0]), 0.2, 0.08) << "about the initial speed";
}

TEST(SwarmScene, IsMuchDenserWhereTheFlocksAre) {
  auto simulation = sceneWith("swarm", {{"objects", "1000"}, {"frames", "100"}});
  const Boxes last = allFrames(*simulation).back();
  const double side = simulation->scene().world.max[0] * 2.0;
  // The most crowded tenth of the world's 1000 cells.
  std::vector<int> cells(1000, 0);
  for (const Aabb& box : last) {
    int cell = 0;
    for (const double coordinate : centreOf(box)) {
      cell = 10 * cell + std::clamp(static_cast<int>(10 * (coordinate / side + 0.5)), 0, 9);
    }
    ++cells[cell];
  }
  std::ranges::sort(cells, std::greater<>());
  int crowded = 0;
  for (int i = 0; i < 100; ++i) crowded += cells[i];
  EXPECT_GT(crowded, 850);
}

}  // namespace
}  // namespace broadmark::tests
