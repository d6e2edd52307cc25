// Boxes around posed shapes, and random sampling.

#include "broadmark/scenes/shape.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "broadmark/scenes/random.h"

namespace broadmark::scenes {
namespace {

/// A rotation by `angle` about an axis.
Pose turnedPose(const Vec3& position, int axis, double angle) {
  Pose pose{.position = position, .rotation = {0, 0, 0, static_cast<float>(std::cos(angle / 2))}};
  pose.rotation[axis] = static_cast<float>(std::sin(angle / 2));
  return pose;
}

void expectBox(const Aabb& box, const Vec3& centre, const Vec3& half) {
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(box.min[axis], centre[axis] - half[axis], 1e-6) << "axis " << axis;
    EXPECT_NEAR(box.max[axis], centre[axis] + half[axis], 1e-6) << "axis " << axis;
  }
  EXPECT_EQ(box.min[3], 0);
  EXPECT_EQ(box.max[3], 0);
}

TEST(TightBox, OfAnUnturnedBodyIsExact) {
  const Aabb box = tightBox(BoxShape{{0.5F, 1, 2}}, {.position = {1, 2, 3}});
  EXPECT_EQ(box, (Aabb{{0.5F, 1, 1, 0}, {1.5F, 3, 5, 0}}));
}

TEST(TightBox, OfACubeTurnedBy45DegreesIsWiderBySqrt2) {
  const auto wide = static_cast<float>(std::numbers::sqrt2 / 2);
  const BoxShape cube{{0.5F, 0.5F, 0.5F}};
  expectBox(tightBox(cube, turnedPose({1, 2, 3}, 2, std::numbers::pi / 4)), {1, 2, 3},
            {wide, wide, 0.5F});
  expectBox(tightBox(cube, turnedPose({1, 2, 3}, 0, -std::numbers::pi / 4)), {1, 2, 3},
            {0.5F, wide, wide});
}

TEST(TightBox, OfABarTurnedBy90And30Degrees) {
  const BoxShape bar{{4, 1, 2}};
  expectBox(tightBox(bar, turnedPose({0, 0, 0}, 1, std::numbers::pi / 2)), {0, 0, 0}, {2, 1, 4});
  const auto cosine = static_cast<float>(std::cos(std::numbers::pi / 6));
  expectBox(tightBox(bar, turnedPose({0, 0, 0}, 2, std::numbers::pi / 6)), {0, 0, 0},
            {4 * cosine + 0.5F, 2 + cosine, 2});
}

TEST(TightBox, OfASphereIsItsRadiusHoweverTurned) {
  const Aabb expected = {{0.25F, 1.25F, 2.25F, 0}, {1.75F, 2.75F, 3.75F, 0}};
  EXPECT_EQ(tightBox(SphereShape{0.75F}, {.position = {1, 2, 3}}), expected);
  EXPECT_EQ(tightBox(SphereShape{0.75F}, turnedPose({1, 2, 3}, 1, 0.7)), expected);
}

TEST(TightBox, OfATurnedBoxTouchesItsCorners) {
  Random random(3);
  for (int i = 0; i < 200; ++i) {
    const auto edge = [&] { return static_cast<float>(0.05 + 5 * random.uniform()); };
    const BoxShape shape{{edge(), edge(), edge()}};
    Eigen::Quaternionf rotation(
        Eigen::Vector4f::NullaryExpr([&] { return static_cast<float>(2 * random.uniform() - 1); }));
    rotation.normalize();
    const Vec3 position = random.inBall(10);
    const Aabb box =
        tightBox(shape, {position, {rotation.x(), rotation.y(), rotation.z(), rotation.w()}});

    Eigen::AlignedBox3d corners;
    for (int corner = 0; corner < 8; ++corner) {
      const auto coordinate = [&](int axis) {
        return static_cast<double>((corner >> axis & 1) == 0 ? -shape.half_extents[axis]
                                                             : shape.half_extents[axis]);
      };
      corners.extend(Eigen::Vector3f(position.data()).cast<double>() +
                     rotation.cast<double>() *
                         Eigen::Vector3d(coordinate(0), coordinate(1), coordinate(2)));
    }
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(box.min[axis], corners.min()[axis], 5e-6);
      EXPECT_NEAR(box.max[axis], corners.max()[axis], 5e-6);
    }
  }
}

TEST(Random, SamplesAreTheSameEverywhere) {
  // The C++ standard specifies the generator's 10000th number for the default seed.
  Random random(std::mt19937_64::default_seed);
  double last = 0;
  for (int i = 0; i < 10000; ++i) last = random.uniform();
  EXPECT_EQ(last, static_cast<double>(9981545732273789042U >> 11) * 0x1p-53);
}

TEST(Random, FillsTheBallUniformly) {
  constexpr int kSamples = 20000;
  constexpr double kRadius = 3;
  Random random(7);
  Vec3 sum{};
  int inner = 0;
  for (int i = 0; i < kSamples; ++i) {
    const Vec3 p = random.inBall(kRadius);
    const double radius = std::hypot(p[0], p[1], p[2]);
    ASSERT_LE(radius, kRadius * (1 + 1e-6));
    if (radius < kRadius / 2) ++inner;
    for (int axis = 0; axis < 3; ++axis) sum[axis] += p[axis];
  }
  // Bounds at five standard deviations.
  EXPECT_NEAR(inner / static_cast<double>(kSamples), 1.0 / 8, 0.012);
  for (const float coordinate : sum) EXPECT_NEAR(coordinate / kSamples, 0, 0.05);
}

}  // namespace
}  // namespace broadmark::scenes
