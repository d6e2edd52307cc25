// Every scene with every object type on every engine: the same bits for the same parameters, even
// beside other simulations in the process, and the statistics in recording_pins.inc.
//
// A combination without a pin fails with the line to add there. Replace an outdated line only if
// the change is understood and intended.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <future>
#include <iterator>
#include <string>
#include <vector>

#include "broadmark/harness/oracle.h"
#include "parts.h"
#include "scenes/scene_runs.h"

namespace broadmark::tests {
namespace {

struct Combination {
  std::string scene;
  std::string object_type;
  std::string engine;

  friend bool operator==(const Combination&, const Combination&) = default;
};

std::vector<std::string> objectTypeIds() {
  std::vector<std::string> ids;
  makeSimulation(builtinScenes().front().id)->visitParameters([&](const Parameter& parameter) {
    if (parameter.name == "object_type") ids = std::get<Choice*>(parameter.value)->options;
  });
  return ids;
}

std::vector<Combination> allCombinations() {
  std::vector<Combination> all;
  for (const SceneListing& scene : builtinScenes()) {
    for (const std::string& object_type : objectTypeIds()) {
      for (const EngineListing& engine : availableEngines()) {
        if (engine.dynamics == Dynamics::replayed) continue;
        all.push_back({scene.id, object_type, engine.id});
      }
    }
  }
  return all;
}

std::unique_ptr<Simulation> simulationOf(const Combination& combination,
                                         const ParameterValues& values) {
  auto simulation = makeSimulation(combination.scene);
  setParameters(*simulation, values);
  setParameters(*simulation,
                {{"object_type", combination.object_type}, {"engine", combination.engine}});
  return simulation;
}

/// Statistics that depend on the physics, but not on single bodies, because rounding may change the
/// path of a body.
struct Statistics {
  double mean_edge = 0;  ///< of the boxes, over all frames
  double height_1 = 0;   ///< mean height of the centres in frame 1
  double height_20 = 0;  ///< mean height of the centres in frame 20
  double spread_20 = 0;  ///< root mean square distance of the centres from the origin
  double pairs = 0;      ///< mean number of overlapping pairs per frame
  double moving_1 = 0;   ///< share of the boxes in frame 1 that differ from the initial pose
  double moving_20 = 0;  ///< share in frame 20 that differ from frame 19
};

/// The boxes of the present bodies.
std::vector<Aabb> presentIn(const std::vector<Aabb>& boxes) {
  std::vector<Aabb> present;
  std::ranges::remove_copy_if(boxes, std::back_inserter(present), isEmpty);
  return present;
}

double spread(const std::vector<Aabb>& boxes) {
  double sum = 0;
  for (const Aabb& box : boxes) {
    const Point centre = centreOf(box);
    sum += dot(centre, centre);
  }
  return std::sqrt(sum / static_cast<double>(boxes.size()));
}

double meanEdge(const Frames& frames) {
  double sum = 0;
  std::size_t count = 0;
  for (const auto& boxes : frames) {
    for (const Aabb& box : presentIn(boxes)) {
      for (int axis = 0; axis < 3; ++axis) sum += box.max[axis] - box.min[axis];
      count += 3;
    }
  }
  return sum / static_cast<double>(count);
}

double movingShare(const std::vector<Aabb>& before, const std::vector<Aabb>& after) {
  std::size_t moving = 0;
  for (std::size_t i = 0; i < after.size(); ++i) moving += before[i] != after[i] ? 1 : 0;
  return static_cast<double>(moving) / static_cast<double>(after.size());
}

Statistics statisticsOf(const Frames& frames, const CollisionFilter& filter) {
  Statistics statistics;
  for (const auto& boxes : frames) {
    statistics.pairs += static_cast<double>(bruteForcePairs(boxes, filter).size()) /
                        static_cast<double>(frames.size());
  }
  statistics.mean_edge = meanEdge(frames);
  statistics.height_1 = meanHeight(presentIn(frames[1]));
  statistics.height_20 = meanHeight(presentIn(frames[20]));
  statistics.spread_20 = spread(presentIn(frames[20]));
  statistics.moving_1 = movingShare(frames[0], frames[1]);
  statistics.moving_20 = movingShare(frames[19], frames[20]);
  return statistics;
}

struct Pin {
  Combination combination;
  Statistics statistics;
};

const std::vector<Pin> kPins = {
#include "recording_pins.inc"
};

std::string pinLine(const Combination& c, const Statistics& s) {
  return fmt::format(
      "{{{{\"{}\", \"{}\", \"{}\"}}, {{{:.4f}, {:.3f}, {:.3f}, {:.3f}, {:.1f}, {:.3f}, {:.3f}}}}},",
      c.scene, c.object_type, c.engine, s.mean_edge, s.height_1, s.height_20, s.spread_20, s.pairs,
      s.moving_1, s.moving_20);
}

class EveryCombination : public testing::TestWithParam<Combination> {};

TEST_P(EveryCombination, HasThePinnedStatistics) {
  // Dense enough for pairs, and large enough for the longest bar.
  auto simulation =
      simulationOf(GetParam(), {{"objects", "200"}, {"frames", "20"}, {"density", "0.05"}});
  const double side = simulation->scene().world.max[0] * 2.0;
  const Statistics now = statisticsOf(allFrames(*simulation), simulation->scene().filter);
  const std::string line = pinLine(GetParam(), now);
  const auto pin = std::ranges::find(kPins, GetParam(), &Pin::combination);
  ASSERT_NE(pin, kPins.end()) << "no pin in tests/scenes/recording_pins.inc; the line to add:\n"
                              << line;
  const Statistics& pinned = pin->statistics;
  SCOPED_TRACE("if this change is intended, the line in tests/scenes/recording_pins.inc is now\n" +
               line);
  EXPECT_NEAR(now.mean_edge, pinned.mean_edge, 0.02 * pinned.mean_edge);
  EXPECT_NEAR(now.height_1, pinned.height_1, 0.005 * side);
  EXPECT_NEAR(now.height_20, pinned.height_20, 0.02 * side);
  EXPECT_NEAR(now.spread_20, pinned.spread_20, 0.02 * side);
  EXPECT_NEAR(now.pairs, pinned.pairs, 2 + 0.1 * pinned.pairs);
  EXPECT_NEAR(now.moving_1, pinned.moving_1, 0.02);
  EXPECT_NEAR(now.moving_20, pinned.moving_20, 0.05);
}

TEST_P(EveryCombination, GivesTheSameBitsWhateverElseRuns) {
  const ParameterValues values = {{"objects", "120"}, {"frames", "8"}, {"density", "0.05"}};
  const ParameterValues other_values = {
      {"objects", "60"}, {"frames", "8"}, {"seed", "2"}, {"substeps", "2"}, {"friction", "0.1"}};
  const auto simulate = [&] { return allFrames(*simulationOf(GetParam(), values)); };
  const Frames alone = simulate();

  auto simulation = simulationOf(GetParam(), values);
  auto other = simulationOf(GetParam(), other_values);
  other->rewind();
  Frames in_turn;
  for (std::optional<Frame> frame = simulation->rewind(); frame; frame = simulation->next()) {
    in_turn.emplace_back(frame->boxes.begin(), frame->boxes.end());
    other->next();
  }
  EXPECT_EQ(in_turn, alone) << "in turn with another";

  auto first = std::async(std::launch::async, simulate);
  auto second = std::async(std::launch::async, simulate);
  EXPECT_EQ(first.get(), alone) << "beside another thread";
  EXPECT_EQ(second.get(), alone) << "beside another thread";
}

INSTANTIATE_TEST_SUITE_P(All, EveryCombination, testing::ValuesIn(allCombinations()),
                         [](const auto& param) {
                           return param.param.scene + "_" + param.param.object_type + "_" +
                                  param.param.engine;
                         });

TEST(RecordingPins, BelongToCombinationsThatExist) {
  const std::vector<Combination> all = allCombinations();
  for (std::size_t i = 0; i < kPins.size(); ++i) {
    const Combination& c = kPins[i].combination;
    if (c.engine == "ode" && !parts::kOde.included) continue;
    const std::string name = c.scene + " " + c.object_type + " " + c.engine;
    EXPECT_NE(std::ranges::find(all, c), all.end()) << name;
    EXPECT_EQ(std::ranges::count(kPins, c, &Pin::combination), 1) << name << " is there twice";
  }
}

}  // namespace
}  // namespace broadmark::tests
