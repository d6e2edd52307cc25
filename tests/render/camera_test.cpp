#include "broadmark/render/camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace broadmark::tests {
namespace {

constexpr float kLargest = std::numeric_limits<float>::max();

Aabb cubeAt(float centre, float side) {
  const float low = centre - side / 2;
  const float high = centre + side / 2;
  return {{low, low, low}, {high, high, high}};
}

/// The eight corners of a box on the screen; fails the test if a corner is behind the eye.
std::vector<std::array<float, 3>> projectedCorners(const Camera& camera, const Aabb& box) {
  std::vector<std::array<float, 3>> corners;
  for (unsigned i = 0; i < 8; ++i) {
    const auto point =
        project(camera, {i & 1U ? box.max[0] : box.min[0], i & 2U ? box.max[1] : box.min[1],
                         i & 4U ? box.max[2] : box.min[2]});
    EXPECT_TRUE(point.has_value());
    if (point) corners.push_back(*point);
  }
  return corners;
}

TEST(ViewSpace, CentresTheBoxAndMakesItsLongestEdgeOne) {
  const ViewSpace space = viewSpaceOf({{10, -4, 100}, {20, 4, 104}});
  EXPECT_EQ(space.toView({{10, -4, 100}, {20, 4, 104}}),
            (Aabb{{-0.5F, -0.4F, -0.2F}, {0.5F, 0.4F, 0.2F}}));
}

TEST(ViewSpace, KeepsItsPrecisionFarFromTheOrigin) {
  // A float resolves steps of 1 at 1e7, and view space must preserve them exactly.
  const ViewSpace space = viewSpaceOf({{1e7F, 0, 0}, {1e7F + 8, 8, 8}});
  EXPECT_FLOAT_EQ(space.toView(std::array{1e7F + 5, 4.0F, 4.0F, 0.0F})[0], 0.125F);
}

TEST(ViewSpace, IsFiniteForEveryFiniteBox) {
  for (const Aabb& box : {Aabb{}, cubeAt(7, 0), cubeAt(0, kLargest), cubeAt(0, 1e-38F),
                          Aabb{{-kLargest, -kLargest, -kLargest}, {kLargest, kLargest, kLargest}},
                          Aabb{{5, 5, 5}, {-5, -5, -5}}}) {
    const ViewSpace space = viewSpaceOf(box);
    EXPECT_GT(space.side, 0);
    for (const float extreme : {-kLargest, 0.0F, kLargest}) {
      for (const float value : space.toView(std::array{extreme, extreme, extreme, 0.0F})) {
        EXPECT_LE(std::abs(value), ViewSpace::kLimit);
      }
    }
  }
}

TEST(ShownBox, IsTheWorldWhenBodiesAreInIt) {
  const Aabb world = cubeAt(0, 10);
  const std::vector<Aabb> boxes = {cubeAt(0, 1), cubeAt(4.9F, 1), cubeAt(1000, 1)};
  EXPECT_EQ(shownBox(world, boxes), world);
  EXPECT_EQ(shownBox(world, {}), world);
}

TEST(ShownBox, HoldsTheBodiesWhenTheWorldDoesNot) {
  const std::vector<Aabb> boxes = {cubeAt(20, 2), cubeAt(30, 2), cubeAt(0, 1)};
  EXPECT_EQ(shownBox(cubeAt(0, 10), boxes), merged(cubeAt(0, 10), boxes[1]));
  // A world without extent, here far away, is ignored.
  EXPECT_EQ(shownBox(cubeAt(-500, 0), boxes), merged(boxes[2], boxes[1]));
}

TEST(ShownBox, AbsentBodiesDoNotCount) {
  const Aabb world = cubeAt(0, 10);
  EXPECT_EQ(shownBox(world, std::vector{kEmptyBox, kEmptyBox, cubeAt(1, 1)}), world);
  EXPECT_EQ(shownBox(world, std::vector{kEmptyBox, kEmptyBox, cubeAt(50, 1)}),
            merged(world, cubeAt(50, 1)));
  EXPECT_EQ(shownBox(cubeAt(-500, 0), std::vector{kEmptyBox, cubeAt(50, 1)}), cubeAt(50, 1));
  EXPECT_EQ(shownBox(world, std::vector{kEmptyBox}), world);
}

TEST(FigureCamera, StandsWhereThePaperHasIt) {
  const Camera camera = figureCamera(cubeAt(0, 1), 1.5);
  EXPECT_FLOAT_EQ(camera.eye[0], 1.71F);
  EXPECT_FLOAT_EQ(camera.eye[1], 0.6F);
  EXPECT_FLOAT_EQ(camera.eye[2], 1.8F);
  EXPECT_EQ(camera.target, (std::array{0.0F, -0.15F, 0.0F}));
}

TEST(FigureCamera, ShowsAllOfTheBoxAndFillsThePicture) {
  for (const double aspect : {0.05, 0.5, 1.0, 16.0 / 9, 20.0}) {
    for (const Aabb& box : {cubeAt(0, 1), Aabb{{-0.5F, -0.01F, -0.5F}, {0.5F, 0.01F, 0.5F}},
                            Aabb{{-0.01F, -0.5F, -0.01F}, {0.01F, 0.5F, 0.01F}}}) {
      SCOPED_TRACE(aspect);
      float widest = 0;
      for (const auto& corner : projectedCorners(figureCamera(box, aspect), box)) {
        for (const float value : corner) EXPECT_LT(std::abs(value), 1);
        widest = std::max({widest, std::abs(corner[0]), std::abs(corner[1])});
      }
      EXPECT_GT(widest, 0.85F);
    }
  }
}

TEST(FigureCamera, KeepsProportionsForEveryAspect) {
  for (const double aspect : {0.5, 1.0, 3.0}) {
    const Camera camera = figureCamera(cubeAt(0, 1), aspect);
    const float width = camera.window_max[0] - camera.window_min[0];
    const float height = camera.window_max[1] - camera.window_min[1];
    EXPECT_NEAR(width / height, aspect, 1e-4);
  }
}

TEST(FigureCamera, IsFiniteForAPoint) {
  for (const float value : viewProjection(figureCamera(cubeAt(0, 0), 1.5))) {
    EXPECT_TRUE(std::isfinite(value));
  }
}

TEST(Project, PutsUpUpAndRightRightAndFarBehindNear) {
  Camera camera;  // at z = 3, towards -z
  const auto middle = project(camera, {0, 0, 0});
  const auto up = project(camera, {0, 0.5F, 0});
  const auto right = project(camera, {0.5F, 0, 0});
  const auto far = project(camera, {0, 0, -2});
  ASSERT_TRUE(middle && up && right && far);
  EXPECT_NEAR((*middle)[0], 0, 1e-6);
  EXPECT_NEAR((*middle)[1], 0, 1e-6);
  // A length of 0.5 at distance 3; the window's width is 1 at distance 1.
  EXPECT_NEAR((*up)[1], 2 * 0.5 / 3, 1e-6);
  EXPECT_NEAR((*right)[0], 2 * 0.5 / 3, 1e-6);
  EXPECT_GT((*far)[2], (*middle)[2]);
  EXPECT_FALSE(project(camera, {0, 0, 4}).has_value());
}

TEST(Project, CopesWithLookingStraightDown) {
  Camera camera;
  camera.eye = {0, 3, 0};
  const auto right = project(camera, {0.5F, 0, 0});
  ASSERT_TRUE(right);
  EXPECT_GT((*right)[0], 0.1F);
  EXPECT_NEAR((*right)[1], 0, 1e-6);
}

}  // namespace
}  // namespace broadmark::tests
