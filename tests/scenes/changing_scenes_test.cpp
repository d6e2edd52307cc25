// The properties of the scenes with appearing and vanishing bodies, layers or worlds.

#include <gmock/gmock.h>

#include <set>

#include "broadmark/error.h"
#include "broadmark/harness/oracle.h"
#include "broadmark/scenes/authored_simulation.h"
#include "engine/helpers.h"
#include "scenes/scene_runs.h"

namespace broadmark::tests {
namespace {

/// The engines that simulate, unlike replays.
std::vector<std::string> liveEngines() {
  std::vector<std::string> ids;
  for (const EngineListing& engine : availableEngines()) {
    if (engine.dynamics != Dynamics::replayed) ids.push_back(engine.id);
  }
  return ids;
}

using testing::Each;
using testing::HasSubstr;

std::size_t populationOf(const Boxes& boxes) {
  return boxes.size() - static_cast<std::size_t>(std::ranges::count_if(boxes, isEmpty));
}

/// The bodies of a layer.
std::vector<std::uint32_t> bodiesIn(const SceneInfo& scene, std::uint8_t layer) {
  std::vector<std::uint32_t> bodies;
  for (std::uint32_t id = 0; id < scene.objects; ++id) {
    if (scene.filter.groupsOf(id).layer == layer) bodies.push_back(id);
  }
  return bodies;
}

bool everMoves(const Frames& frames, std::uint32_t body) {
  return std::ranges::any_of(frames,
                             [&](const Boxes& boxes) { return boxes[body] != frames[0][body]; });
}

TEST(FountainScene, PopulationRisesAndFallsAndIdsAreUsedAgain) {
  for (const std::string& engine : liveEngines()) {
    SCOPED_TRACE(engine);
    auto simulation = sceneWith("fountain", {{"objects", "100"},
                                             {"frames", "190"},
                                             {"lifetime", "30"},
                                             {"period", "90"},
                                             {"engine", engine}});
    EXPECT_FALSE(simulation->scene().all_present);
    const Frames frames = allFrames(*simulation);
    EXPECT_EQ(populationOf(frames[0]), 25U);
    std::size_t least = 100;
    std::size_t most = 0;
    for (std::size_t i = 60; i < frames.size(); ++i) {
      least = std::min(least, populationOf(frames[i]));
      most = std::max(most, populationOf(frames[i]));
    }
    EXPECT_LT(least, 40U);
    EXPECT_GT(most, 60U);
    int arrivals = 0;
    for (std::size_t i = 1; i < frames.size(); ++i) {
      for (std::size_t id = 0; id < 100; ++id) {
        arrivals += isEmpty(frames[i - 1][id]) && !isEmpty(frames[i][id]) ? 1 : 0;
      }
    }
    EXPECT_GT(arrivals, 100) << "more than there are ids";
  }
}

TEST(FountainScene, BodiesAreThrownUpAndFall) {
  auto simulation = sceneWith("fountain", {{"objects", "200"}, {"frames", "120"}, {"filled", "0"}});
  const Frames frames = allFrames(*simulation);
  EXPECT_EQ(populationOf(frames[0]), 0U) << "an empty world";
  std::size_t first = 0;
  while (isEmpty(frames[first][0])) ++first;
  const auto height = [&](std::size_t after) { return centreOf(frames[first + after][0])[1]; };
  const double side = 2.0 * simulation->scene().world.max[0];
  EXPECT_GT(height(20), height(0) + 0.2 * side);
  EXPECT_LT(height(70), height(20));
}

/// The layer of each body in each frame of a scene, and a check of Frame::filter_changed.
std::vector<std::vector<int>> layersIn(FrameSource& source) {
  std::vector<std::vector<int>> layers;
  recordAll(source, [&](const Frame& frame) {
    std::vector<int> now;
    std::vector<std::uint32_t> changed;
    for (std::uint32_t id = 0; id < frame.boxes.size(); ++id) {
      now.push_back(frame.filterIn(source.scene()).groupsOf(id).layer);
      if (!layers.empty() && layers.back()[id] != now[id]) changed.push_back(id);
    }
    layers.push_back(std::move(now));
    EXPECT_THAT(frame.filter_changed, testing::ElementsAreArray(changed)) << frame.index;
  });
  return layers;
}

TEST(FountainScene, BodiesThatFellDoNotCollideWithThoseInTheAir) {
  for (const std::string engine : {"bullet", "ode"}) {
    SCOPED_TRACE(engine);
    auto simulation =
        sceneWith("fountain", {{"objects", "100"}, {"frames", "150"}, {"engine", engine}});
    EXPECT_TRUE(simulation->scene().filter_changes);
    EXPECT_EQ(simulation->scene().filter.matrix(), LayerMatrix().set(0, 0).set(1, 1));
    const Frames frames = allFrames(*simulation);
    const auto layers = layersIn(*simulation);
    const double surface = simulation->scene().world.min[1] + 0.25;
    std::size_t fallen = 0;
    for (std::size_t i = 1; i < frames.size(); ++i) {
      for (std::size_t id = 0; id < 100; ++id) {
        if (isEmpty(frames[i][id]) || layers[i][id] <= layers[i - 1][id]) continue;
        EXPECT_LE(frames[i - 1][id].min[1], surface);
        ++fallen;
      }
    }
    EXPECT_GT(fallen, 20U);
  }
  auto without = sceneWith("fountain", {{"objects", "100"}, {"pool", "off"}});
  EXPECT_FALSE(without->scene().filter_changes);
  EXPECT_TRUE(without->scene().filter.wantsAll());
}

TEST(ShooterScene, ProjectilesCollideWithTheLevelAloneForThreeFrames) {
  auto simulation = sceneWith("shooter", {{"objects", "400"}, {"frames", "60"}});
  EXPECT_TRUE(simulation->scene().filter_changes);
  const Frames frames = allFrames(*simulation);
  const auto layers = layersIn(*simulation);
  std::size_t armed = 0;
  for (const std::uint32_t id : bodiesIn(simulation->scene(), 2)) {
    int unarmed_frames = 0;
    for (std::size_t i = 1; i < frames.size(); ++i) {
      if (isEmpty(frames[i - 1][id]) && !isEmpty(frames[i][id])) {
        EXPECT_EQ(layers[i][id], 4) << id << " in frame " << i;
      }
      if (layers[i][id] == 2 && unarmed_frames > 0) {
        EXPECT_EQ(unarmed_frames, 3) << id << " in frame " << i;
        ++armed;
      }
      unarmed_frames = layers[i][id] == 4 ? unarmed_frames + 1 : 0;
    }
  }
  EXPECT_GT(armed, 20U);
  auto at_once = sceneWith("shooter", {{"objects", "400"}, {"arming", "0"}});
  EXPECT_FALSE(at_once->scene().filter_changes);
}

// An id that is used again before its projectile is armed begins again.
TEST(ShooterScene, ShortLivedProjectilesAreNeverArmed) {
  auto simulation = sceneWith(
      "shooter", {{"objects", "100"}, {"frames", "60"}, {"lifetime", "2"}, {"pause", "2"}});
  const Frames frames = allFrames(*simulation);
  const auto layers = layersIn(*simulation);
  std::size_t present = 0;
  for (const std::uint32_t id : bodiesIn(simulation->scene(), 2)) {
    for (std::size_t i = 1; i < frames.size(); ++i) {
      if (isEmpty(frames[i][id])) continue;
      EXPECT_EQ(layers[i][id], 4) << id << " in frame " << i;
      ++present;
    }
  }
  EXPECT_GT(present, 20U);
}

TEST(ShooterScene, HasFourLayersAndOneOfNewProjectiles) {
  auto simulation = sceneWith("shooter", {{"objects", "400"}, {"frames", "60"}});
  const SceneInfo& scene = simulation->scene();
  EXPECT_FALSE(scene.all_present);
  const LayerMatrix matrix = scene.filter.matrix();
  const auto wanted = LayerMatrix().set(0, 1).set(0, 2).set(1, 1).set(1, 2).set(1, 3).set(0, 4);
  EXPECT_EQ(matrix, wanted);
  const Frames frames = allFrames(*simulation);

  for (const std::uint8_t layer : {std::uint8_t{0}, std::uint8_t{3}}) {
    for (const std::uint32_t body : bodiesIn(scene, layer)) {
      EXPECT_FALSE(isEmpty(frames[0][body]) || everMoves(frames, body)) << body;
    }
  }
  EXPECT_EQ(bodiesIn(scene, 0).size(), 200U);
  EXPECT_EQ(bodiesIn(scene, 1).size(), 8U);
  EXPECT_EQ(bodiesIn(scene, 3).size(), 20U);
  for (const std::uint32_t character : bodiesIn(scene, 1)) {
    EXPECT_TRUE(everMoves(frames, character));
    for (const Boxes& boxes : frames) EXPECT_FALSE(isEmpty(boxes[character]));
  }
  // Each character fires eight projectiles every 20 frames, which exist for 25 frames.
  std::size_t most = 0;
  for (const std::uint32_t projectile : bodiesIn(scene, 2)) {
    EXPECT_TRUE(isEmpty(frames[0][projectile]));
    std::size_t lived = 0;
    for (const Boxes& boxes : frames) {
      lived = isEmpty(boxes[projectile]) ? 0 : lived + 1;
      most = std::max(most, lived);
    }
  }
  EXPECT_GE(most, 25U);
  EXPECT_LT(most, 60U);
  double largest = 0;
  for (const std::uint32_t box : bodiesIn(scene, 0)) {
    largest = std::max(largest, longestEdgeOf(frames[0][box]));
  }
  EXPECT_GT(largest, 3) << "boxes of all sizes";
}

TEST(ShooterScene, ProjectilesMeetCharactersAndTheLevelAlone) {
  auto simulation = sceneWith("shooter", {{"objects", "400"}, {"frames", "60"}});
  std::set<std::pair<int, int>> met;
  const CollisionFilter filter = simulation->scene().filter;
  for (const Boxes& boxes : allFrames(*simulation)) {
    for (const Pair& pair : bruteForcePairs(boxes, filter)) {
      const int a = filter.groupsOf(pair.a).layer;
      const int b = filter.groupsOf(pair.b).layer;
      met.emplace(std::min(a, b), std::max(a, b));
    }
  }
  EXPECT_TRUE(met.contains({0, 1}));
  EXPECT_TRUE(met.contains({0, 2}));
  EXPECT_TRUE(met.contains({1, 3}));
  EXPECT_FALSE(met.contains({0, 0}) || met.contains({2, 2}) || met.contains({2, 3}));
}

TEST(WorldScene, OnlyTheMoversTakeTime) {
  auto simulation = sceneWith("world", {{"objects", "20000"}, {"frames", "10"}, {"movers", "30"}});
  const SceneInfo scene = simulation->scene();
  EXPECT_TRUE(scene.all_present);
  EXPECT_EQ(bodiesIn(scene, 1).size(), 30U);
  const auto movers = bodiesIn(scene, 1);
  EXPECT_FALSE(scene.filter.matrix().collide(0, 0));
  EXPECT_TRUE(scene.filter.matrix().collide(0, 1));
  EXPECT_EQ(populationOf(boxesOf(simulation->rewind())), 20000U);
  while (const auto frame = simulation->next()) {
    EXPECT_THAT(*frame->changed, testing::ElementsAreArray(movers));
  }
}

TEST(WorldScene, TakesAnyNumberOfMovers) {
  for (const std::string movers : {"0", "1", "7", "50", "1000"}) {
    auto simulation = sceneWith("world", {{"objects", "50"}, {"frames", "2"}, {"movers", movers}});
    EXPECT_EQ(bodiesIn(simulation->scene(), 1).size(), std::min(50UL, std::stoul(movers)));
    EXPECT_TRUE(allInside(allFrames(*simulation)[2], simulation->scene().world, 0.01));
  }
}

TEST(WorldsScene, CopiesAreAtTheSamePlaceAndMoveAsIfAlone) {
  for (const std::string& engine : liveEngines()) {
    SCOPED_TRACE(engine);
    const ParameterValues single = {{"objects", "12"},
                                    {"frames", "50"},
                                    {"bodies_per_world", "12"},
                                    {"episode", "40"},
                                    {"engine", engine}};
    const Frames alone = allFrames(*sceneWith("worlds", single));
    ParameterValues multiple = single;
    multiple["objects"] = "30";
    auto simulation = sceneWith("worlds", multiple);
    const SceneInfo scene = simulation->scene();
    EXPECT_EQ(scene.world, sceneWith("worlds", single)->scene().world);
    EXPECT_EQ(scene.filter.groupsOf(11).world, 0U);
    EXPECT_EQ(scene.filter.groupsOf(12).world, 1U);
    EXPECT_EQ(scene.filter.groupsOf(29).world, 2U) << "the last one is smaller";
    const Frames frames = allFrames(*simulation);
    for (std::size_t i = 0; i < frames.size(); ++i) {
      EXPECT_TRUE(std::equal(alone[i].begin(), alone[i].end(), frames[i].begin())) << i;
    }
  }
}

TEST(WorldsScene, ACopyStartsAgainAfterAnEpisode) {
  const Frames frames = allFrames(*sceneWith(
      "worlds", {{"objects", "40"}, {"frames", "45"}, {"episode", "20"}, {"engine", "kinematic"}}));
  // Reset after frame 20, with the same motion again.
  for (std::size_t body = 0; body < 20; ++body) {
    EXPECT_EQ(frames[21][body], frames[41][body]);
    EXPECT_NE(frames[21][body], frames[20][body]);
  }
  EXPECT_EQ(frames[31][20], frames[11][20]) << "the other copy half an episode later";
}

TEST(StreamingScene, TilesAroundTheViewerAreLoadedInBatchesAndUnloaded) {
  auto simulation = sceneWith("streaming", {{"objects", "2000"},
                                            {"frames", "120"},
                                            {"tiles", "6"},
                                            {"view", "1"},
                                            {"batches", "3"},
                                            {"period", "100"}});
  EXPECT_FALSE(simulation->scene().all_present);
  const Frames frames = allFrames(*simulation);
  const std::vector<std::uint32_t> movers = bodiesIn(simulation->scene(), 1);
  EXPECT_EQ(movers.size(), 40U);
  EXPECT_EQ(populationOf(frames[0]), movers.size());
  EXPECT_LT(populationOf(frames[1]), populationOf(frames[2]));
  EXPECT_LT(populationOf(frames[2]), populationOf(frames[3]));
  // About nine of 36 tiles.
  for (std::size_t k = 10; k < frames.size(); ++k) {
    EXPECT_NEAR(static_cast<double>(populationOf(frames[k])), 40 + 1960 / 4, 250) << k;
  }
  std::size_t loads = 0;
  for (std::uint32_t body = 40; body < 2000; ++body) {
    const Aabb* place = nullptr;
    for (std::size_t k = 1; k < frames.size(); ++k) {
      const Aabb& box = frames[k][body];
      if (isEmpty(box)) continue;
      ASSERT_TRUE(place == nullptr || box == *place) << body;
      place = &box;
      if (isEmpty(frames[k - 1][body])) ++loads;
    }
  }
  EXPECT_GT(loads, 1960U);  // some twice
}

TEST(StreamingScene, OneTileIsLoadedAtTheStart) {
  const Frames at_once = allFrames(*sceneWith(
      "streaming", {{"objects", "500"}, {"frames", "5"}, {"tiles", "1"}, {"batches", "1"}}));
  EXPECT_EQ(populationOf(at_once[0]), 10U);
  EXPECT_EQ(populationOf(at_once[1]), 10U);
  EXPECT_EQ(populationOf(at_once[2]), 500U);
  EXPECT_EQ(populationOf(at_once[5]), 500U);
  const Frames batches = allFrames(*sceneWith(
      "streaming", {{"objects", "500"}, {"frames", "7"}, {"tiles", "1"}, {"batches", "5"}}));
  EXPECT_EQ(populationOf(batches[2]), 10U + 98);
  EXPECT_EQ(populationOf(batches[6]), 500U);
}

TEST(SpotScene, AllBodiesAreAtOnePlaceAndThenApart) {
  for (const std::string engine : {"bullet", "kinematic"}) {
    auto simulation =
        sceneWith("spot", {{"objects", "80"}, {"frames", "40"}, {"hold", "6"}, {"engine", engine}});
    const Frames frames = allFrames(*simulation);
    for (std::size_t i = 0; i <= 6; ++i) EXPECT_THAT(frames[i], Each(frames[0][0])) << i;
    EXPECT_EQ(pairsAmong(frames[6]), 80U * 79 / 2);
    EXPECT_LT(pairsAmong(frames[40]), 100U) << engine;
  }
}

TEST(ChangingScenes, BecomeAuthoredScenesOfTheBodiesThatAreThere) {
  auto fountain = sceneWith("fountain", {{"objects", "60"}, {"frames", "30"}});
  const Frames frames = allFrames(*fountain);
  const scenes::AuthoredScene scene = scenes::sceneFromFrame(*fountain, 30);
  EXPECT_EQ(scene.bodies.size(), populationOf(frames[30]));

  auto shooter = sceneWith("shooter", {{"objects", "100"}, {"frames", "30"}});
  const scenes::AuthoredScene level = scenes::sceneFromFrame(*shooter, 30);
  EXPECT_EQ(level.collide, shooter->scene().filter.matrix());
  EXPECT_EQ(level.triggers, 1U << 3);
  EXPECT_EQ(level.bodies[0].layer, 0);
  EXPECT_TRUE(level.bodies[0].frozen);
  EXPECT_EQ(scenes::parseAuthoredScene(formatAuthoredScene(level), "again"), level);

  auto worlds = sceneWith("worlds", {{"objects", "60"}, {"frames", "3"}});
  EXPECT_THAT(inputErrorOf([&] { scenes::sceneFromFrame(*worlds, 3); }), HasSubstr("worlds"));
}

}  // namespace
}  // namespace broadmark::tests
