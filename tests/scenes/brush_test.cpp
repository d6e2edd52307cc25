// Every brush: the same bodies for the same seed, without overlap.

#include "broadmark/scenes/brush.h"

#include <gtest/gtest.h>

#include <cmath>

#include "broadmark/error.h"
#include "broadmark/scenes/registry.h"
#include "entries.h"

namespace broadmark::scenes {
namespace {

class EveryBrush : public ::testing::TestWithParam<BrushEntry> {};

TEST_P(EveryBrush, PaintsTheSameBodiesForTheSameSeed) {
  const auto brush = GetParam().create();
  for (const ObjectType& type : objectTypes()) {
    Paint colour;
    colour.object_type.value = type.listing.id;
    const Stroke stroke = paint(*brush, colour, {1, 2, 3}, OccupiedSpace());
    EXPECT_EQ(paint(*brush, colour, {1, 2, 3}, OccupiedSpace()).bodies, stroke.bodies);
    EXPECT_GT(stroke.bodies.size(), 0U);
    EXPECT_EQ(static_cast<double>(stroke.bodies.size() + stroke.left_out),
              std::floor(brush->count(1)));
    for (const AuthoredBody& body : stroke.bodies) EXPECT_EQ(faultOfBody(body), "");
    if (!brush->scatters()) continue;
    colour.seed = 2;
    EXPECT_NE(paint(*brush, colour, {1, 2, 3}, OccupiedSpace()).bodies, stroke.bodies);
  }
}

TEST_P(EveryBrush, LeavesRoomUnlessItMayOverlap) {
  const auto brush = GetParam().create();
  Paint colour;
  colour.object_type.value = "assorted";
  std::vector<AuthoredBody> bodies = {AuthoredBody{.shape = BoxShape{{50, 0.5F, 50}}}};
  for (int stroke = 0; stroke < 3; ++stroke) {
    colour.seed = stroke;
    for (AuthoredBody& body : paint(*brush, colour, {0, 0, 0}, bodies).bodies) {
      bodies.push_back(body);
    }
  }
  const std::vector<Aabb> boxes = boxesOf({.bodies = bodies});
  for (std::size_t b = 0; b < boxes.size(); ++b) {
    for (std::size_t a = 0; a < b; ++a) {
      Aabb inner = boxes[a];
      for (int axis = 0; axis < 3; ++axis) {
        const float skin = brush->scatters() ? 0 : 2e-3F * (inner.max[axis] - inner.min[axis]);
        inner.min[axis] += skin;
        inner.max[axis] -= skin;
      }
      EXPECT_FALSE(overlaps(inner, boxes[b])) << a << " " << b;
    }
  }
  colour.overlap = true;
  EXPECT_EQ(paint(*brush, colour, {0, 0, 0}, bodies).left_out, 0U);
}

INSTANTIATE_TEST_SUITE_P(All, EveryBrush, ::testing::ValuesIn(brushEntries()),
                         [](const auto& tested) { return tested.param.listing.id; });

std::unique_ptr<Brush> brushWith(const std::string& id, const ParameterValues& values) {
  auto brush = entryOf(brushEntries(), id, "brush").create();
  setParameters(*brush, values);
  return brush;
}

TEST(Brush, ALatticeOfTouchingCubesIsWhole) {
  const auto lattice = brushWith(
      "lattice", {{"count_x", "7"}, {"count_y", "3"}, {"count_z", "5"}, {"spacing", "0.1"}});
  Paint colour;
  colour.scale = 0.1;
  const Stroke stroke = paint(*lattice, colour, {}, OccupiedSpace());
  EXPECT_EQ(stroke.left_out, 0U);
  ASSERT_EQ(stroke.bodies.size(), 105U);
  EXPECT_NEAR(stroke.bodies.front().pose.position[0], -0.3, 1e-6);
  EXPECT_NEAR(stroke.bodies.back().pose.position[2], 0.2, 1e-6);
}

TEST(Brush, ARandomOneFillsToItsDensity) {
  const auto random = brushWith(
      "random", {{"density", "0.05"}, {"size_x", "20"}, {"size_y", "10"}, {"size_z", "5"}});
  const Stroke stroke = paint(*random, {}, {}, OccupiedSpace());
  EXPECT_EQ(stroke.bodies.size(), 50U);
  EXPECT_EQ(stroke.left_out, 0U);
}

TEST(Brush, WhereThereIsNoRoomBodiesAreLeftOut) {
  const Stroke stroke =
      paint(*brushWith("ball", {{"count", "50"}, {"radius", "1"}}), {}, {}, OccupiedSpace());
  EXPECT_GT(stroke.left_out, 20U);
  EXPECT_EQ(stroke.bodies.size() + stroke.left_out, 50U);
}

TEST(Brush, TooManyBodiesAreRefused) {
  const auto random = brushWith("random", {{"density", "1"}, {"size_x", "1e6"}, {"size_y", "1e6"}});
  EXPECT_THROW(paint(*random, {}, {}, OccupiedSpace()), InputError);
}

}  // namespace
}  // namespace broadmark::scenes
