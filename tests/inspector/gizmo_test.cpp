// The gizmo's geometry: which handle is hit, and how dragging it changes the bodies.
#include "inspector/authoring/gizmo.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace broadmark::tests {
namespace {

constexpr float kReach = 8;

/// A camera at a corner of the gizmo, so that no axis points at the eye.
class GizmoTest : public testing::Test {
 protected:
  GizmoTest() {
    viewpoint.width = 600;
    viewpoint.height = 600;
    viewpoint.camera.eye = {6, 5, 8};
    viewpoint.camera.target = {0, 0, 0};
  }

  [[nodiscard]] ViewProjection sight() const { return {ViewSpace{}, viewpoint}; }

  [[nodiscard]] Pixel gripOf(Tool tool, Handle handle) const {
    for (const HandleShape& shape : handleShapes(tool, pose, sight())) {
      if (shape.handle == handle) return sight().pixelOf(shape.grip).value();
    }
    ADD_FAILURE() << "no such handle";
    return {};
  }

  /// Drags the handle by its grip, by a vector in pixels.
  [[nodiscard]] GizmoDrag::Outcome drag(Tool tool, Handle handle, Pixel by,
                                        bool snaps = false) const {
    const Pixel from = gripOf(tool, handle);
    return GizmoDrag(tool, handle, pose, sight(), from)
        .at({from[0] + by[0], from[1] + by[1]}, tools, snaps);
  }

  Viewpoint viewpoint;
  GizmoPose pose;
  Tools tools;
};

TEST_F(GizmoTest, EachHandleIsHitAtItsGripAndNoneFarAway) {
  for (const Tool tool : {Tool::move, Tool::turn, Tool::scale}) {
    const auto shapes = handleShapes(tool, pose, sight());
    EXPECT_EQ(shapes.size(), tool == Tool::move ? 6U : tool == Tool::turn ? 3U : 4U);
    for (const HandleShape& shape : shapes) {
      const Pixel grip = sight().pixelOf(shape.grip).value();
      EXPECT_EQ(handleUnder(shapes, sight(), grip, kReach), shape.handle)
          << kTools.nameOf(tool) << " " << kHandles.nameOf(shape.handle);
    }
    EXPECT_EQ(handleUnder(shapes, sight(), {5, 5}, kReach), std::nullopt);
  }
}

TEST_F(GizmoTest, AnAxisSeenFromItsEndCannotBeDragged) {
  viewpoint.camera.eye = {0, 0, 10};
  for (const HandleShape& shape : handleShapes(Tool::move, pose, sight())) {
    EXPECT_NE(shape.handle, Handle::z);
    EXPECT_NE(shape.handle, Handle::yz);
    EXPECT_NE(shape.handle, Handle::zx);
  }
}

TEST_F(GizmoTest, WhatIsDraggedAlongAnAxisStaysUnderTheMouse) {
  const auto outcome = drag(Tool::move, Handle::x, {40, 0});
  EXPECT_NE(outcome.change.move[0], 0);
  EXPECT_EQ(outcome.change.move[1], 0);
  EXPECT_EQ(outcome.change.move[2], 0);
  // The moved grip is the point of the axis nearest to the mouse on the screen.
  const Pixel from = gripOf(Tool::move, Handle::x);
  const double grip = 0.8;
  const Pixel now = sight().pixelOf({grip + outcome.change.move[0], 0, 0}).value();
  const Pixel on = sight().pixelOf({grip + outcome.change.move[0] + 0.01, 0, 0}).value();
  const double along_x = on[0] - now[0];
  const double along_y = on[1] - now[1];
  const double length = std::hypot(along_x, along_y);
  const double missed = ((from[0] + 40 - now[0]) * along_x + (from[1] - now[1]) * along_y) / length;
  EXPECT_LT(std::abs(missed), 6);
}

TEST_F(GizmoTest, APlaneKeepsWhatIsAcrossIt) {
  const auto outcome = drag(Tool::move, Handle::zx, {25, 15});
  EXPECT_NE(outcome.change.move[0], 0);
  EXPECT_EQ(outcome.change.move[1], 0);
  EXPECT_NE(outcome.change.move[2], 0);
}

TEST_F(GizmoTest, ItsOwnAxesAreThoseOfATurnedBody) {
  const float half = std::numbers::sqrt2_v<float> / 2;
  pose.rotation = {0, half, 0, half};  // x to -z, z to x
  const auto outcome = drag(Tool::move, Handle::z, {40, 10});
  EXPECT_NE(outcome.change.move[0], 0);
  EXPECT_NEAR(outcome.change.move[1], 0, 1e-5);
  EXPECT_NEAR(outcome.change.move[2], 0, 1e-5);
}

TEST_F(GizmoTest, ARingTurnsAboutItsAxis) {
  const auto outcome = drag(Tool::turn, Handle::y, {60, 0});
  const Quaternion& turn = outcome.change.turn;
  EXPECT_EQ(turn[0], 0);
  EXPECT_NE(turn[1], 0);
  EXPECT_EQ(turn[2], 0);
  EXPECT_NEAR(turn[1] * turn[1] + turn[3] * turn[3], 1, 1e-6);
}

TEST_F(GizmoTest, ScalingIsAlongAnAxisOrAlongAll) {
  const auto scale = drag(Tool::scale, Handle::y, {0, -30}).change.scale;
  EXPECT_GT(scale[1], 1);
  EXPECT_EQ(scale[0], 1);
  EXPECT_EQ(scale[2], 1);
  const auto all = drag(Tool::scale, Handle::all, {30, 0}).change.scale;
  EXPECT_GT(all[0], 1);
  EXPECT_EQ(all[0], all[1]);
  EXPECT_EQ(all[1], all[2]);
  for (const float factor : drag(Tool::scale, Handle::all, {-5000, 5000}).change.scale) {
    EXPECT_GT(factor, 0) << "whatever the mouse does";
  }
}

TEST_F(GizmoTest, SnappingGoesBySteps) {
  tools.move_step = 0.5;
  const float moved = drag(Tool::move, Handle::x, {90, 30}, true).change.move[0];
  EXPECT_NE(moved, 0);
  EXPECT_EQ(std::remainder(moved, 0.5F), 0);
  tools.turn_step = 15;
  const float sine = drag(Tool::turn, Handle::y, {70, 0}, true).change.turn[1];
  const double degrees = 2 * std::asin(double{sine}) * 180 / std::numbers::pi;
  EXPECT_NEAR(std::remainder(degrees, 15.0), 0, 1e-3);
  tools.scale_step = 0.25;
  const float factor = drag(Tool::scale, Handle::all, {45, 0}, true).change.scale[0];
  EXPECT_NEAR(std::remainder(factor, 0.25F), 0, 1e-6);
}

TEST(Angles, AreThoseOfTheRotation) {
  using scenes::anglesOf;
  using scenes::rotationBy;
  const auto expect_same = [](const Quaternion& a, const Quaternion& b) {
    EXPECT_TRUE(rotationMatrix(a).isApprox(rotationMatrix(b), 1e-5)) << rotationMatrix(a);
  };
  const float half = std::sqrt(0.5F);
  expect_same(rotationBy({90, 0, 0}), {half, 0, 0, half});
  expect_same(rotationBy({0, 0, -90}), {0, 0, -half, half});
  EXPECT_EQ(anglesOf({0, 0, 0, 1}), Vec3{});
  for (const float x : {-170.0F, 0.0F, 20.0F, 90.0F}) {
    for (const float y : {-90.0F, -30.0F, 0.0F, 90.0F}) {  // upright at ±90
      for (const float z : {-179.0F, 0.0F, 45.0F}) {
        const Quaternion rotation = rotationBy({x, y, z});
        expect_same(rotationBy(anglesOf(rotation)), rotation);
        if (std::abs(y) == 90) continue;
        const Vec3 angles = anglesOf(rotation);
        EXPECT_NEAR(angles[0], x, 1e-3);
        EXPECT_NEAR(angles[1], y, 1e-3);
        EXPECT_NEAR(angles[2], z, 1e-3);
      }
    }
  }
}

}  // namespace
}  // namespace broadmark::tests
