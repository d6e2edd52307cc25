// Explosion: a density that decreases in every frame.

#include "scenes/scene_runs.h"

namespace broadmark::tests {
namespace {

/// The share of the bodies nearer to the world's centre than `radius` sides.
double shareWithin(double radius, const Boxes& boxes, const Aabb& world) {
  const double limit = radius * (world.max[0] - world.min[0]);
  const auto count = std::ranges::count_if(
      boxes, [&](const Aabb& box) { return lengthOf(centreOf(box)) < limit; });
  return static_cast<double>(count) / static_cast<double>(boxes.size());
}

TEST(ExplosionScene, StartsDenselyWithoutOverlaps) {
  for (const std::string type : {"cubes", "spheres"}) {
    for (const std::string count : {"3", "1000", "4000"}) {
      auto simulation = sceneWith("explosion", {{"objects", count}, {"object_type", type}});
      const Frame frame = simulation->rewind();
      const Boxes start(frame.boxes.begin(), frame.boxes.end());
      EXPECT_EQ(pairsAmong(start), 0U) << count << ' ' << type;
      if (start.size() < 1000) continue;
      EXPECT_EQ(shareWithin(0.15, start, simulation->scene().world), 1) << "all in a small ball";
      EXPECT_LT(shareWithin(0.10, start, simulation->scene().world), 0.6) << "evenly in it";
    }
  }
}

TEST(ExplosionScene, DensityFallsAtEverySizeAlike) {
  for (const std::string count : {"500", "4000"}) {
    auto simulation =
        sceneWith("explosion", {{"objects", count}, {"frames", "60"}, {"engine", "kinematic"}});
    const std::vector<Boxes> frames = allFrames(*simulation);
    const Aabb& world = simulation->scene().world;
    double before = 1;
    for (const std::size_t frame : {15U, 30U, 45U, 60U}) {
      const double share = shareWithin(0.15, frames[frame], world);
      EXPECT_LT(share, 0.85 * before) << "frame " << frame;
      before = share;
    }
    EXPECT_LT(before, 0.25);
    EXPECT_GT(before, 0.03) << "slow bodies are still there";
  }
}

TEST(ExplosionScene, OutwardSpeedGrowsWithTheDistance) {
  auto simulation = sceneWith("explosion", {{"objects", "800"},
                                            {"frames", "1"},
                                            {"engine", "kinematic"},
                                            {"gravity", "0"},
                                            {"slowest", "1"}});
  const std::vector<Boxes> frames = allFrames(*simulation);
  const double side = simulation->scene().world.max[0] * 2.0;
  double fastest = 0;
  for (std::size_t i = 0; i < 800; ++i) {
    const Point start = centreOf(frames[0][i]);
    const Point moved = way(frames[0][i], frames[1][i]);
    fastest = std::max(fastest, 30 * lengthOf(moved) / side);
    if (lengthOf(start) < 0.05 * side) continue;
    EXPECT_GT(dot(start, moved), 0.95 * lengthOf(start) * lengthOf(moved)) << "outwards";
  }
  EXPECT_NEAR(fastest, 0.25, 0.01) << "the initial speed, in sides per second";
}

}  // namespace
}  // namespace broadmark::tests
