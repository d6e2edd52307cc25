// City: bodies of very different sizes, most of them static.

#include "scenes/scene_runs.h"

namespace broadmark::tests {
namespace {

std::vector<std::size_t> moversAmong(const std::vector<Boxes>& frames) {
  std::vector<std::size_t> movers;
  for (std::size_t i = 0; i < frames[0].size(); ++i) {
    if (std::ranges::any_of(frames, [&](const Boxes& boxes) { return boxes[i] != frames[0][i]; })) {
      movers.push_back(i);
    }
  }
  return movers;
}

TEST(CityScene, TwoPercentMove) {
  for (const auto& [objects, expected] :
       {std::pair{"1", 1U}, {"2", 1U}, {"50", 1U}, {"51", 2U}, {"1000", 20U}, {"2500", 50U}}) {
    auto simulation = sceneWith("city", {{"objects", objects}, {"frames", "20"}});
    EXPECT_EQ(moversAmong(allFrames(*simulation)).size(), expected) << objects;
  }
  EXPECT_EQ(moversAmong(allFrames(*sceneWith(
                            "city", {{"objects", "300"}, {"frames", "10"}, {"movers", "0"}})))
                .size(),
            0U);
}

TEST(CityScene, BuildingsStandOnTheGroundWithSizesFarApart) {
  for (const std::string type : {"cubes", "spheres", "assorted"}) {
    auto simulation =
        sceneWith("city", {{"objects", "3000"}, {"frames", "5"}, {"object_type", type}});
    const std::vector<Boxes> frames = allFrames(*simulation);
    const Aabb& world = simulation->scene().world;
    const double side = world.max[0] * 2.0;
    EXPECT_TRUE(allInside(frames[0], world, 1e-4 * side)) << type;
    const std::vector<std::size_t> movers = moversAmong(frames);
    std::vector<double> sizes;
    for (std::size_t i = 0; i < 3000; ++i) {
      sizes.push_back(longestEdgeOf(frames[0][i]));
      if (std::ranges::binary_search(movers, i)) continue;
      EXPECT_NEAR(frames[0][i].min[1], world.min[1], 1e-5 * side) << "building " << i;
    }
    std::ranges::sort(sizes);
    EXPECT_GT(sizes.back() / sizes.front(), 20) << type;
    EXPECT_GT(sizes.back() / sizes[1500], 8) << type << ": a few are much larger than most";
  }
}

TEST(CityScene, StreetsAreFree) {
  // No mover starts in a building or drives into one. Without collisions, because these may push
  // movers off their lanes.
  auto simulation =
      sceneWith("city", {{"objects", "2000"}, {"frames", "90"}, {"engine", "kinematic"}});
  const std::vector<Boxes> frames = allFrames(*simulation);
  const double side = simulation->scene().world.max[0] * 2.0;
  const std::vector<std::size_t> movers = moversAmong(frames);
  ASSERT_EQ(movers.size(), 40U);
  for (const std::size_t frame : {0U, 30U, 90U}) {
    for (const std::size_t mover : movers) {
      for (std::size_t i = 0; i < 2000; ++i) {
        if (std::ranges::binary_search(movers, i)) continue;
        EXPECT_FALSE(overlaps(frames[frame][mover], frames[frame][i])) << "frame " << frame;
      }
    }
  }
  double farthest = 0;
  for (const std::size_t mover : movers) {
    farthest = std::max(farthest, lengthOf(way(frames[0][mover], frames[90][mover])));
  }
  EXPECT_GT(farthest, 0.2 * side) << "movers move";
}

TEST(CityScene, BuildingsOverlapWhereTheyAreCrowded) {
  const auto pairs = [](const std::string& crowding) {
    auto simulation = sceneWith("city", {{"objects", "2000"}, {"crowding", crowding}});
    const Frame start = simulation->rewind();
    return pairsAmong({start.boxes.begin(), start.boxes.end()});
  };
  EXPECT_GT(pairs("1.1"), 100U);
  EXPECT_LT(pairs("0.9"), 3U) << "only movers that meet in the streets";
}

}  // namespace
}  // namespace broadmark::tests
