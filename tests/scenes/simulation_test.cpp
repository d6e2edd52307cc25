// Whole simulations: parameters, determinism and plausible motion.

#include "broadmark/scenes/simulation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <future>

#include "broadmark/change_detector.h"
#include "engine/helpers.h"
#include "scenes/scene_runs.h"

namespace broadmark::tests {
namespace {

using testing::HasSubstr;

class EveryScene : public testing::TestWithParam<SceneListing> {};

TEST_P(EveryScene, DescribesItselfByItsParameters) {
  auto simulation = makeSimulation(GetParam().id);
  EXPECT_EQ(simulation->scene().name, GetParam().name);
  EXPECT_EQ(simulation->scene().object_type, "Cubes");
  EXPECT_EQ(simulation->scene().objects, 1000U);
  EXPECT_EQ(simulation->scene().frames, 1000U);
  const double density = std::stod(parameterValues(*simulation).at("density"));
  // Worlds states the density of a single world.
  const bool worlds = GetParam().id == "worlds";
  EXPECT_FLOAT_EQ(simulation->scene().world.max[0],
                  static_cast<float>(std::cbrt((worlds ? 20 : 1000) / density) / 2));

  setParameters(*simulation,
                {{"objects", "270"}, {"frames", "3"}, {"density", "0.01"}, {"scale", "2"}});
  if (worlds) setParameters(*simulation, {{"bodies_per_world", "270"}});
  EXPECT_EQ(simulation->scene().objects, 270U);
  EXPECT_EQ(simulation->scene().frames, 3U);
  for (int axis = 0; axis < 3; ++axis) {  // (270 · 2³ / 0.01)^(1/3) = 60
    EXPECT_FLOAT_EQ(simulation->scene().world.min[axis], -30);
    EXPECT_FLOAT_EQ(simulation->scene().world.max[axis], 30);
  }
}

TEST_P(EveryScene, GivesTheSameBitsForTheSameSeedOnly) {
  const ParameterValues values = {{"objects", "120"}, {"frames", "20"}, {"seed", "5"}};
  auto simulation = sceneWith(GetParam().id, values);
  const Frames first = allFrames(*simulation);
  EXPECT_EQ(first.size(), 21U);
  EXPECT_EQ(allFrames(*simulation), first) << "after rewinding";
  EXPECT_EQ(allFrames(*sceneWith(GetParam().id, values)), first) << "in another instance";

  auto other_values = values;
  other_values["seed"] = "6";
  const Frames other = allFrames(*sceneWith(GetParam().id, other_values));
  EXPECT_NE(other.front(), first.front());
  EXPECT_NE(other.back(), first.back());
}

TEST_P(EveryScene, SimulationsAliveAtOnceDoNotInfluenceEachOther) {
  const ParameterValues values = {{"objects", "150"}, {"frames", "15"}};
  const ParameterValues other_values = {
      {"objects", "90"}, {"frames", "15"}, {"seed", "2"}, {"substeps", "2"}, {"friction", "0.1"}};
  const Frames alone = allFrames(*sceneWith(GetParam().id, values));
  const Frames other_alone = allFrames(*sceneWith(GetParam().id, other_values));

  auto simulation = sceneWith(GetParam().id, values);
  auto other = sceneWith(GetParam().id, other_values);
  simulation->rewind();
  other->rewind();
  for (std::size_t i = 1; i <= 15; ++i) {
    ASSERT_EQ(boxesOf(*simulation->next()), alone[i]);
    ASSERT_EQ(boxesOf(*other->next()), other_alone[i]);
  }
}

TEST_P(EveryScene, SaysExactlyWhatChangedAndWhoIsAbsent) {
  auto simulation = sceneWith(GetParam().id, {{"objects", "200"}, {"frames", "40"}});
  Frame frame = simulation->rewind();
  ASSERT_TRUE(frame.changed);
  EXPECT_TRUE(frame.changed->empty());
  const bool all_present = simulation->scene().all_present;
  ChangeDetector found;
  found.complete({frame.index, frame.boxes});
  while (const auto next = simulation->next()) {
    EXPECT_THAT(*next->changed,
                testing::ElementsAreArray(*found.complete({next->index, next->boxes}).changed));
    EXPECT_TRUE(!all_present || std::ranges::none_of(next->boxes, isEmpty));
  }
}

TEST_P(EveryScene, ThreadsDoNotInfluenceEachOther) {
  const ParameterValues values = {{"objects", "150"}, {"frames", "15"}};
  const auto simulate = [&] { return allFrames(*sceneWith(GetParam().id, values)); };
  const Frames alone = simulate();
  std::vector<std::future<Frames>> others;
  for (int i = 0; i < 3; ++i) others.push_back(std::async(std::launch::async, simulate));
  for (auto& other : others) EXPECT_EQ(other.get(), alone);
}

bool hasSizesOfItsOwn(const std::string& scene) {
  return scene == "city" || scene == "shooter" || scene == "streaming" || scene == "world";
}

TEST_P(EveryScene, BoxesAreValidTightAndStayInTheWorld) {
  auto simulation = sceneWith(GetParam().id, {{"objects", "300"}, {"frames", "90"}});
  const double diagonal = std::sqrt(3.0);
  bool moved = false;
  auto previous = boxesOf(simulation->rewind());
  while (const auto frame = simulation->next()) {
    ASSERT_EQ(frame->boxes.size(), 300U);
    EXPECT_LT(reachOutside(frame->boxes, simulation->scene().world), 0.2)
        << "frame " << frame->index;
    for (const Aabb& box : frame->boxes) {
      ASSERT_EQ(box.min[3], 0);
      ASSERT_EQ(box.max[3], 0);
      if (isEmpty(box) || hasSizesOfItsOwn(GetParam().id)) continue;
      for (int axis = 0; axis < 3; ++axis) {
        const double edge = box.max[axis] - box.min[axis];
        ASSERT_GE(edge, 1 - 1e-5) << "smaller than the cube";
        ASSERT_LE(edge, diagonal + 1e-5) << "larger than the turned cube";
      }
    }
    moved = moved || previous != boxesOf(*frame);
    previous = boxesOf(*frame);
  }
  EXPECT_TRUE(moved);
}

TEST_P(EveryScene, OfVeryFewBodiesWorksWithEveryEngineAndObjectType) {
  const auto options = [](const char* name) {
    std::vector<std::string> found;
    makeSimulation("freefall")->visitParameters([&](const Parameter& parameter) {
      if (parameter.name == name) found = std::get<Choice*>(parameter.value)->options;
    });
    return found;
  };
  for (const std::string& engine : options("engine")) {
    for (const std::string& type : options("object_type")) {
      for (const std::string count : {"0", "1", "2", "30"}) {
        SCOPED_TRACE(engine + ' ' + type + ' ' + count);
        auto simulation = sceneWith(
            GetParam().id,
            {{"objects", count}, {"frames", "12"}, {"engine", engine}, {"object_type", type}});
        for (const auto& boxes : allFrames(*simulation)) {
          ASSERT_EQ(boxes.size(), std::stoul(count));
          for (const Aabb& box : boxes) {
            if (isEmpty(box)) continue;
            for (int axis = 0; axis < 3; ++axis) {
              ASSERT_TRUE(std::isfinite(box.min[axis]) && std::isfinite(box.max[axis]));
              ASSERT_LE(box.min[axis], box.max[axis]);
            }
          }
        }
      }
    }
  }
}

TEST_P(EveryScene, OfOneBodyOrWithTheFewestFramesWorks) {
  EXPECT_EQ(allFrames(*sceneWith(GetParam().id, {{"objects", "1"}, {"frames", "5"}})).size(), 6U);
  EXPECT_EQ(allFrames(*sceneWith(GetParam().id, {{"objects", "40"}, {"frames", "1"}})).size(), 2U);
}

INSTANTIATE_TEST_SUITE_P(All, EveryScene, testing::ValuesIn(builtinScenes()),
                         [](const auto& param) { return param.param.name; });

TEST(Simulation, IsFoundByIdOrNameInAnyCase) {
  EXPECT_EQ(makeSimulation("freefall")->scene().name, "FreeFall");
  EXPECT_EQ(makeSimulation("FreeFall")->scene().name, "FreeFall");
  EXPECT_EQ(makeSimulation("BROWNIAN")->scene().name, "Brownian");
  EXPECT_THAT(inputErrorOf([] { makeSimulation("freefal"); }),
              testing::AllOf(HasSubstr("freefal"), HasSubstr("'freefall'")));
}

TEST(Simulation, RejectsWrongParameters) {
  const auto message = [](const ParameterValues& values) {
    return inputErrorOf([&] { sceneWith("brownian", values); });
  };
  EXPECT_THAT(message({{"densty", "1"}}), HasSubstr("density"));
  EXPECT_THAT(message({{"launch_shore", "1"}}), HasSubstr("launch_share"));
  EXPECT_THAT(message({{"density", "0"}}), HasSubstr("density"));
  EXPECT_THAT(message({{"objects", "-1"}}), HasSubstr("objects"));
  EXPECT_THAT(message({{"objects", "99999999999"}}), HasSubstr("objects"));
  EXPECT_THAT(message({{"object_type", "cones"}}), HasSubstr("cubes"));
  EXPECT_THAT(message({{"engine", "bulet"}}), HasSubstr("bullet"));
  EXPECT_THAT(message({{"strength", "4"}}), HasSubstr("strength")) << "of another scene";
  EXPECT_NO_THROW(sceneWith("brownian", {{"objects", "10"}, {"engine", "bullet"}}));
}

TEST(Simulation, NewParametersTakeEffectAtTheNextRewind) {
  auto simulation = sceneWith("freefall", {{"objects", "10"}, {"frames", "4"}});
  simulation->rewind();
  setParameters(*simulation, {{"frames", "2"}});
  EXPECT_EQ(simulation->scene().frames, 4U) << "of the running simulation";
  simulation->rewind();
  EXPECT_EQ(simulation->scene().frames, 2U);
}

TEST(FreeFallSimulation, FallsAndComesToRestOnTheFloor) {
  auto simulation = sceneWith("freefall", {{"objects", "50"}, {"frames", "450"}});
  const Frames frames = allFrames(*simulation);
  const Aabb& world = simulation->scene().world;
  EXPECT_LT(meanHeight(frames[100]), meanHeight(frames[0]) - 0.1 * world.max[1]);
  EXPECT_LT(meanHeight(frames[200]), meanHeight(frames[100]));
  EXPECT_EQ(frames[449], frames[450]) << "all bodies sleep";

  const std::vector<Aabb>& rest = frames.back();
  EXPECT_LT(meanHeight(rest), world.min[1] + 2);
  EXPECT_LT(reachOutside(rest, world), 0.02);
  for (std::size_t i = 0; i < rest.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      // The inscribed balls of two unit cubes overlap only if the cubes do.
      EXPECT_GT(lengthOf(way(rest[i], rest[j])), 0.97) << i << " penetrates " << j;
    }
  }
}

TEST(FreeFallSimulation, FrozenBodiesStayForGood) {
  auto simulation = sceneWith("freefall", {{"objects", "60"},
                                           {"frames", "60"},
                                           {"freeze_slow", "on"},
                                           {"freeze_after", "50"},
                                           {"freeze_speed", "1000"},
                                           {"freeze_angular_speed", "1000"}});
  const Frames frames = allFrames(*simulation);
  EXPECT_NE(frames[49], frames[50]);
  for (std::size_t i = 51; i <= 60; ++i) EXPECT_EQ(frames[i], frames[50]) << "frame " << i;
}

TEST(BrownianSimulation, NeverSettles) {
  auto simulation = sceneWith("brownian", {{"objects", "100"}, {"frames", "300"}});
  const Frames frames = allFrames(*simulation);
  double path = 0;
  for (std::size_t i = 0; i < 100; ++i) path += lengthOf(way(frames[299][i], frames[300][i]));
  EXPECT_GT(path / 100, 0.01) << "mean way of a body in the last frame";
  EXPECT_NEAR(meanHeight(frames[300]), 0, 0.3 * simulation->scene().world.max[1]);
}

TEST(GravitySimulation, GathersBodiesAtTheWallThatGravityPointsTo) {
  auto simulation = sceneWith("gravity", {{"objects", "100"}, {"frames", "80"}, {"period", "1e6"}});
  const Frames frames = allFrames(*simulation);
  double mean_x = 0;
  for (const Aabb& box : frames.back()) mean_x += centreOf(box)[0] / 100;
  EXPECT_GT(mean_x, 0.5 * simulation->scene().world.max[0]);
}

TEST(Simulation, BodiesThatLeaveTheWorldAreFrozen) {
  // Bodies start in a ball that extends beyond the world.
  auto simulation =
      sceneWith("brownian", {{"objects", "200"}, {"frames", "20"}, {"initial_radius", "0.8"}});
  const Frames frames = allFrames(*simulation);
  const Aabb& world = simulation->scene().world;
  const auto outside = [&](const Aabb& box) {
    const auto c = centreOf(box);
    for (int axis = 0; axis < 3; ++axis) {
      if (std::abs(c[axis]) > world.max[axis] + 1e-3) return true;
    }
    return false;
  };
  int escaped = 0;
  int moving = 0;
  for (std::size_t i = 0; i < 200; ++i) {
    if (outside(frames[1][i])) {
      ++escaped;
      for (std::size_t k = 2; k <= 20; ++k) ASSERT_EQ(frames[k][i], frames[1][i]) << "body " << i;
    } else if (frames[20][i] != frames[1][i]) {
      ++moving;
    }
  }
  EXPECT_GT(escaped, 20);
  EXPECT_GT(moving, 50);
}

}  // namespace
}  // namespace broadmark::tests
