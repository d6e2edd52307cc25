// Conveyor: crossing streams of different speeds, and bodies that restart.

#include <map>

#include "scenes/scene_runs.h"

namespace broadmark::tests {
namespace {

/// The dominant axis of a move.
int axisOf(const Point& move) {
  int axis = 0;
  for (int other = 1; other < 3; ++other) {
    if (std::abs(move[other]) > std::abs(move[axis])) axis = other;
  }
  return axis;
}

TEST(ConveyorScene, EveryBeltHasItsOwnSpeed) {
  auto simulation =
      sceneWith("conveyor", {{"objects", "600"}, {"frames", "2"}, {"engine", "kinematic"}});
  const std::vector<Boxes> frames = allFrames(*simulation);
  const double side = simulation->scene().world.max[0] * 2.0;
  for (std::size_t i = 0; i < 600; ++i) {
    const std::size_t belt = i % 12;
    const Point move = way(frames[0][i], frames[1][i]);
    if (lengthOf(move) > side / 4) continue;  // restarted
    EXPECT_EQ(axisOf(move), static_cast<int>(belt % 3)) << "body " << i;
    EXPECT_NEAR(30 * lengthOf(move) / side, 0.5 * static_cast<double>(belt + 1) / 12, 1e-3)
        << "body " << i;
  }
}

TEST(ConveyorScene, BodiesAreTakenBackToTheStartAtASteadyRate) {
  for (const std::string engine : {"kinematic", "bullet"}) {
    auto simulation =
        sceneWith("conveyor", {{"objects", "600"}, {"frames", "120"}, {"engine", engine}});
    const std::vector<Boxes> frames = allFrames(*simulation);
    const double side = simulation->scene().world.max[0] * 2.0;
    std::map<std::size_t, int> teleports;  // by half of the time
    for (std::size_t frame = 1; frame <= 120; ++frame) {
      for (std::size_t i = 0; i < 600; ++i) {
        const double length = lengthOf(way(frames[frame - 1][i], frames[frame][i]));
        EXPECT_TRUE(length < 0.1 * side || length > 0.8 * side) << "neither a step nor a restart";
        if (length > side / 2) ++teleports[(frame - 1) / 60];
      }
    }
    // The mean speed is 13/48 of a side per second, so more than half of the bodies in two seconds.
    for (const std::size_t half : {0U, 1U}) {
      EXPECT_GT(teleports[half], 250) << engine;
      EXPECT_LT(teleports[half], 420) << engine;
    }
  }
}

TEST(ConveyorScene, StreamsCrossAndKeepTheirBelts) {
  auto simulation = sceneWith("conveyor", {{"objects", "1500"}, {"frames", "90"}});
  const std::vector<Boxes> frames = allFrames(*simulation);
  const Aabb& world = simulation->scene().world;
  const double side = world.max[0] * 2.0;
  std::map<std::pair<std::size_t, std::size_t>, int> crossings;
  int off = 0;  // bodies that have been pushed far off their belt
  for (const std::size_t frame : {30U, 60U, 90U}) {
    const Boxes& boxes = frames[frame];
    EXPECT_TRUE(allInside(boxes, world, 0.2));
    for (std::size_t b = 0; b < boxes.size(); ++b) {
      const int axis = static_cast<int>(b % 12 % 3);
      for (int across = 0; across < 3; ++across) {
        if (across == axis) continue;
        const double distance = std::abs(std::abs(centreOf(boxes[b])[across]) - 0.22 * side);
        off += distance > 0.12 * side ? 1 : 0;
      }
      for (std::size_t a = 0; a < b; ++a) {
        if (a % 3 != b % 3 && overlaps(boxes[a], boxes[b])) ++crossings[{a % 3, b % 3}];
      }
    }
  }
  EXPECT_LT(off, 3 * 1500 / 100);
  EXPECT_EQ(crossings.size(), 6U) << "of any two axes, in either order of ids";
}

}  // namespace
}  // namespace broadmark::tests
