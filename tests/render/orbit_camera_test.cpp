#include "broadmark/render/orbit_camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "broadmark/render/picking.h"

namespace broadmark::tests {
namespace {

constexpr double kWideAspect = 16.0 / 9;
const Aabb kUnit{{-0.5F, -0.5F, -0.5F}, {0.5F, 0.5F, 0.5F}};

OrbitCamera tilted() {
  OrbitCamera camera;
  camera.pivot = {0.1F, -0.2F, 0.3F};
  camera.yaw = 0.7F;
  camera.pitch = 0.4F;
  return camera;
}

/// x and y in [-1, 1].
std::array<float, 2> seenAt(const OrbitCamera& camera, const std::array<float, 3>& point) {
  const auto at = project(toCamera(camera, kWideAspect, kUnit), point);
  EXPECT_TRUE(at.has_value());
  return at ? std::array{(*at)[0], (*at)[1]} : std::array{9.0F, 9.0F};
}

void expectNearPoint(const std::array<float, 2>& a, const std::array<float, 2>& b,
                     float tolerance) {
  EXPECT_NEAR(a[0], b[0], tolerance);
  EXPECT_NEAR(a[1], b[1], tolerance);
}

TEST(OrbitCamera, LooksAtThePivotFromTheDistance) {
  const OrbitCamera orbit = tilted();
  const Camera camera = toCamera(orbit, kWideAspect, kUnit);
  EXPECT_EQ(camera.target, orbit.pivot);
  EXPECT_NEAR(focus(camera), orbit.distance, 1e-5F);
  expectNearPoint(seenAt(orbit, orbit.pivot), {0, 0}, 1e-5F);
}

TEST(OrbitCamera, DirectionsShowTheAxesTheyPromise) {
  const auto axes = [](Direction direction) {
    return axesOf(toCamera(viewedFrom({}, direction), kWideAspect, kUnit));
  };
  EXPECT_NEAR(axes(Direction::front).right[0], 1, 1e-5F);
  EXPECT_NEAR(axes(Direction::front).back[2], 1, 1e-5F);
  EXPECT_NEAR(axes(Direction::back).back[2], -1, 1e-5F);
  EXPECT_NEAR(axes(Direction::right).back[0], 1, 1e-5F);
  EXPECT_NEAR(axes(Direction::left).back[0], -1, 1e-5F);
  // From above: x to the right, z towards the lower border.
  EXPECT_NEAR(axes(Direction::top).back[1], 1, 1e-3F);
  EXPECT_NEAR(axes(Direction::top).right[0], 1, 1e-3F);
  EXPECT_NEAR(axes(Direction::top).up[2], -1, 1e-3F);
  EXPECT_NEAR(axes(Direction::bottom).back[1], -1, 1e-3F);
  const CameraAxes figure = axesOf(figureCamera(kUnit, kWideAspect));
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(axes(Direction::figure).back[i], figure.back[i], 1e-4F);
  }
}

TEST(OrbitCamera, TurnsWithoutTippingOver) {
  EXPECT_EQ(orbited({}, 0, 10).pitch, OrbitCamera::kSteepest);
  EXPECT_EQ(orbited({}, 0, -10).pitch, -OrbitCamera::kSteepest);
  const OrbitCamera turned = orbited({}, 100, 0.25F);
  EXPECT_LE(std::abs(turned.yaw), std::numbers::pi_v<float> + 1e-5F);
  EXPECT_EQ(turned.pivot, OrbitCamera{}.pivot);
  EXPECT_EQ(turned.distance, OrbitCamera{}.distance);
}

TEST(OrbitCamera, PanningKeepsThePivotUnderThePointer) {
  const OrbitCamera camera = tilted();
  // A fraction of the height is twice as much in coordinates from -1 to 1.
  const OrbitCamera moved = panned(camera, 0.2F, -0.1F);
  expectNearPoint(seenAt(moved, camera.pivot), {0.4F / static_cast<float>(kWideAspect), -0.2F},
                  1e-4F);
}

TEST(OrbitCamera, ZoomingKeepsThePointUnderThePointer) {
  const OrbitCamera camera = tilted();
  const std::array point = pointUnder(camera, kWideAspect, 0.6F, -0.3F);
  expectNearPoint(seenAt(camera, point), {0.6F, -0.3F}, 1e-4F);
  for (const float factor : {0.01F, 0.5F, 3.0F}) {
    const OrbitCamera near = zoomed(camera, factor, point);
    EXPECT_NEAR(near.distance, factor * camera.distance, 1e-5F);
    expectNearPoint(seenAt(near, point), {0.6F, -0.3F}, 1e-3F);
  }
}

TEST(OrbitCamera, ZoomEndsAtItsLimits) {
  OrbitCamera camera = tilted();
  for (int i = 0; i < 300; ++i) camera = zoomed(camera, 0.5F, {0.1F, 0, 0});
  EXPECT_EQ(camera.distance, OrbitCamera::kNearest);
  for (int i = 0; i < 300; ++i) camera = zoomed(camera, 2, {0.1F, 0, 0});
  EXPECT_EQ(camera.distance, OrbitCamera::kFarthest);
  for (const float coordinate : camera.pivot) EXPECT_TRUE(std::isfinite(coordinate));
}

TEST(OrbitCamera, FliesAlongTheAxesOfThePicture) {
  const OrbitCamera camera = tilted();
  const CameraAxes axes = axesOf(toCamera(camera, kWideAspect, kUnit));
  const OrbitCamera flying = flown(camera, 0.5F, 0.25F, -0.125F);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(
        flying.pivot[i] - camera.pivot[i],
        camera.distance * (-0.5F * axes.back[i] + 0.25F * axes.right[i] - 0.125F * axes.up[i]),
        1e-5F);
  }
}

TEST(OrbitCamera, FocusShowsAllOfTheBoxAndFillsThePicture) {
  for (const double aspect : {0.3, 1.0, 16.0 / 9, 4.0}) {
    for (const auto& [direction, name] : kDirections.entries) {
      for (const Aabb& box : {kUnit, Aabb{{0.2F, 0.1F, -0.3F}, {0.21F, 0.12F, -0.2999F}}}) {
        const OrbitCamera orbit = focusedOn(viewedFrom(tilted(), direction), box, aspect);
        const Camera camera = toCamera(orbit, aspect, kUnit);
        float widest = 0;
        for (unsigned i = 0; i < 8; ++i) {
          const auto at =
              project(camera, {i & 1U ? box.max[0] : box.min[0], i & 2U ? box.max[1] : box.min[1],
                               i & 4U ? box.max[2] : box.min[2]});
          ASSERT_TRUE(at.has_value());
          for (const float value : *at) EXPECT_LT(std::abs(value), 1) << name;
          widest = std::max({widest, std::abs((*at)[0]), std::abs((*at)[1])});
        }
        EXPECT_GT(widest, 0.6F) << name << " at aspect " << aspect;
      }
    }
  }
}

TEST(OrbitCamera, FocusOnAPointKeepsItsNeighbourhood) {
  const OrbitCamera camera = focusedOn(tilted(), {{0.1F, 0.1F, 0.1F}, {0.1F, 0.1F, 0.1F}}, 1.5);
  EXPECT_GT(camera.distance, OrbitCamera::kNearest);
  EXPECT_LT(camera.distance, 1e-3F);
  EXPECT_EQ(camera.pivot, (std::array{0.1F, 0.1F, 0.1F}));
}

TEST(OrbitCamera, TheWayBetweenViewsBeginsAndEndsWithThem) {
  const OrbitCamera from = viewedFrom({}, Direction::figure);
  const OrbitCamera to = focusedOn(viewedFrom({}, Direction::left),
                                   {{0.4F, 0.4F, 0.4F}, {0.401F, 0.401F, 0.401F}}, kWideAspect);
  EXPECT_EQ(between(from, to, 0), from);
  EXPECT_EQ(between(from, to, 1), to);
  EXPECT_EQ(between(from, to, 7), to);
  EXPECT_EQ(between(from, from, 0.5F), from);
}

TEST(OrbitCamera, TheAimStaysInThePictureOnTheWay) {
  const OrbitCamera from = focusedOn(viewedFrom({}, Direction::figure), kUnit, kWideAspect);
  const OrbitCamera to =
      focusedOn(from, {{0.4F, 0.4F, 0.4F}, {0.401F, 0.401F, 0.401F}}, kWideAspect);
  for (float t = 0; t <= 1; t += 0.05F) {
    const auto at = seenAt(between(from, to, t), to.pivot);
    EXPECT_LT(std::abs(at[0]), 1) << t;
    EXPECT_LT(std::abs(at[1]), 1) << t;
  }
}

TEST(OrbitCamera, TurnsTheShortWayRound) {
  OrbitCamera from;
  from.yaw = 3;
  OrbitCamera to;
  to.yaw = -3;
  const float middle = between(from, to, 0.5F).yaw;
  EXPECT_NEAR(std::cos(middle), -1, 1e-4F);
}

TEST(OrbitCamera, DepthSuitsTheWholeWorldAndASingleBody) {
  const auto depthSteps = [](const OrbitCamera& orbit, float size) {
    const Camera camera = toCamera(orbit, kWideAspect, kUnit);
    EXPECT_LT(camera.near, orbit.distance / 2);
    // The far plane is behind the whole world.
    EXPECT_GT(camera.far, orbit.distance);
    EXPECT_TRUE(project(camera, orbit.pivot).has_value());
    const CameraAxes axes = axesOf(camera);
    std::array<float, 3> behind;
    for (std::size_t i = 0; i < 3; ++i) behind[i] = orbit.pivot[i] - size * axes.back[i];
    return (project(camera, behind).value()[2] - project(camera, orbit.pivot).value()[2]) *
           float{1 << 23};
  };
  // A 24-bit depth buffer resolves a hundredth of the contents in many steps.
  EXPECT_GT(depthSteps(focusedOn({}, kUnit, kWideAspect), 0.01F), 1000);
  EXPECT_GT(depthSteps(focusedOn({}, {{0, 0, 0}, {0.001F, 0.001F, 0.001F}}, kWideAspect), 1e-5F),
            100);
}

}  // namespace
}  // namespace broadmark::tests
