// Brownian bodies that pass through each other: spread evenly, all moving, with a steady number of
// pairs, at any size and speed.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>

#include "broadmark/reference_pairs.h"
#include "scenes/scene_runs.h"

namespace broadmark::tests {
namespace {

struct Crowd {
  std::string objects;
  std::string initial_speed;
  std::string substeps;
  std::string object_type;
};

class KinematicBrownian : public testing::TestWithParam<Crowd> {};

double pairsPerBody(const Boxes& boxes) {
  return static_cast<double>(sweptPairs(boxes).size()) / static_cast<double>(boxes.size());
}

/// The share of the centres in the outer eighth of the world on some axis, on average over the
/// axes.
double shareNearWalls(const Boxes& boxes, const Aabb& world) {
  std::size_t near = 0;
  for (const Aabb& box : boxes) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double edge = double{world.max[axis]} - world.min[axis];
      near += std::abs(centreOf(box)[axis]) > 7 * edge / 16 ? 1 : 0;
    }
  }
  return static_cast<double>(near) / static_cast<double>(3 * boxes.size());
}

TEST_P(KinematicBrownian, StaysEvenAndInMotion) {
  const Crowd& crowd = GetParam();
  auto simulation = sceneWith("brownian",
                              {{"objects", crowd.objects},
                               {"frames", "300"},
                               {"initial_speed", crowd.initial_speed},
                               {"substeps", crowd.substeps},
                               {"object_type", crowd.object_type}},
                              "kinematic");
  const Boxes first = boxesOf(simulation->rewind());
  const Aabb world = simulation->scene().world;
  const double near_walls = shareNearWalls(first, world);
  Boxes before = first;
  double sum = 0;
  int samples = 0;
  for (std::optional<Frame> frame = simulation->next(); frame; frame = simulation->next()) {
    std::size_t moving = 0;
    for (std::size_t i = 0; i < before.size(); ++i) moving += before[i] != frame->boxes[i] ? 1 : 0;
    ASSERT_EQ(moving, before.size()) << "frame " << frame->index;
    before = boxesOf(*frame);
    if (frame->index % 20 != 0) continue;
    EXPECT_NEAR(shareNearWalls(before, world), near_walls, 0.02) << "frame " << frame->index;
    sum += pairsPerBody(before);
    ++samples;
    // Of single frames also the chance: the number of pairs is one of many independent events.
    EXPECT_NEAR(pairsPerBody(before), pairsPerBody(first), 0.1 * pairsPerBody(first))
        << "frame " << frame->index;
  }
  EXPECT_NEAR(sum / samples, pairsPerBody(first), 0.05 * pairsPerBody(first));
  EXPECT_TRUE(allInside(before, world, 1e-3));
  EXPECT_TRUE(simulation->escapes().empty());
}

INSTANTIATE_TEST_SUITE_P(
    Crowds, KinematicBrownian,
    testing::Values(Crowd{"4000", "0.75", "2", "cubes"}, Crowd{"4000", "0.75", "2", "spheres"},
                    Crowd{"4000", "0.01", "2", "cubes"}, Crowd{"4000", "10", "1", "cubes"},
                    Crowd{"16000", "0.75", "2", "cubes"}, Crowd{"4000", "3", "1", "assorted"}),
    [](const auto& param) {
      std::string name =
          param.param.objects + "_" + param.param.initial_speed + "_" + param.param.object_type;
      std::ranges::replace(name, '.', '_');
      return name;
    });

TEST(KinematicBrownian, TellsTheDefaultsOfItsEngineAndKeepsWhatWasChosen) {
  auto simulation = makeSimulation("brownian");
  const ParameterValues bullet = parameterValues(*simulation);
  setParameters(*simulation, {{"friction", "0.3"}});
  setParameters(*simulation, {{"engine", "kinematic"}});
  ParameterValues values = parameterValues(*simulation);
  EXPECT_EQ(values["restitution"], "1");
  EXPECT_EQ(values["friction"], "0.3");
  setParameters(*simulation, {{"engine", "bullet"}, {"friction", bullet.at("friction")}});
  EXPECT_EQ(parameterValues(*simulation), bullet);

  // A file of all parameters means what it says.
  values["restitution"] = "0";
  auto again = makeSimulation("brownian");
  setParameters(*again, values);
  EXPECT_EQ(parameterValues(*again), values);
}

}  // namespace
}  // namespace broadmark::tests
