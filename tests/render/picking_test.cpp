#include "broadmark/render/picking.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "broadmark/render/orbit_camera.h"
#include "support/drawing.h"

namespace broadmark::tests {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr int kScreenWidth = 400;
constexpr int kScreenHeight = 300;

/// A world of side 100 around (1000, 0, 0): world space and view space differ.
const Aabb kFarWorld = cube({1000, 0, 0}, 100);

Viewpoint viewpointFrom(Direction direction) {
  const ViewSpace space = viewSpaceOf(kFarWorld);
  const double aspect = static_cast<double>(kScreenWidth) / kScreenHeight;
  const OrbitCamera orbit = focusedOn(viewedFrom({}, direction), space.toView(kFarWorld), aspect);
  return {toCamera(orbit, aspect, space.toView(kFarWorld)), kScreenWidth, kScreenHeight, 0};
}

std::array<float, 2> screenPixelOf(const Viewpoint& viewpoint,
                                   const std::array<float, 4>& world_point) {
  return tests::pixelOf(viewpoint, viewSpaceOf(kFarWorld).toView(world_point));
}

std::array<float, 4> middle(const Aabb& box) {
  return {(box.min[0] + box.max[0]) / 2, (box.min[1] + box.max[1]) / 2,
          (box.min[2] + box.max[2]) / 2, 0};
}

std::optional<std::uint32_t> pick(const std::vector<Aabb>& boxes, const Viewpoint& viewpoint,
                                  const std::array<float, 2>& pixel, BodyMask mask = {},
                                  float smallest = 2) {
  const auto hit =
      pickBody(boxes, viewSpaceOf(kFarWorld), viewpoint, pixel[0], pixel[1], mask, smallest);
  return hit ? std::optional(hit->body) : std::nullopt;
}

TEST(Picking, RaysGoThroughTheirPixels) {
  const Viewpoint viewpoint = viewpointFrom(Direction::figure);
  for (const auto& [x, y] : {std::pair{0.0F, 0.0F}, {200.0F, 150.0F}, {399.5F, 12.25F}}) {
    const Ray ray = rayThrough(viewpoint, x, y);
    const std::array at = tests::pixelOf(viewpoint, ray.at(1.3F));
    EXPECT_NEAR(at[0], x, 1e-2F);
    EXPECT_NEAR(at[1], y, 1e-2F);
  }
}

TEST(Picking, FindsEachBodyUnderItsMiddle) {
  const std::vector<Aabb> boxes = {cube({970, 10, 0}, 5), cube({1030, -10, 20}, 5),
                                   cube({1000, 40, -30}, 5)};
  for (const auto& [direction, name] : kDirections.entries) {
    SCOPED_TRACE(name);
    const Viewpoint viewpoint = viewpointFrom(direction);
    for (std::uint32_t body = 0; body < boxes.size(); ++body) {
      EXPECT_EQ(pick(boxes, viewpoint, screenPixelOf(viewpoint, middle(boxes[body]))), body);
    }
    EXPECT_EQ(pick(boxes, viewpoint, {2, 2}), std::nullopt);
  }
}

TEST(Picking, TakesTheForemostInAnyOrder) {
  const Viewpoint viewpoint = viewpointFrom(Direction::front);
  std::vector<Aabb> boxes = {cube({1000, 0, -20}, 10), cube({1000, 0, 20}, 10)};
  EXPECT_EQ(pick(boxes, viewpoint, {200, 150}), 1U);
  std::swap(boxes[0], boxes[1]);
  EXPECT_EQ(pick(boxes, viewpoint, {200, 150}), 0U);
}

TEST(Picking, DepthIsThatOfThePointHit) {
  const Viewpoint viewpoint = viewpointFrom(Direction::front);
  const std::vector<Aabb> boxes = {cube({1000, 0, 20}, 10)};
  const auto hit = pickBody(boxes, viewSpaceOf(kFarWorld), viewpoint, 200, 150).value();
  EXPECT_NEAR(rayThrough(viewpoint, 200, 150).at(hit.depth)[2], 0.25F, 1e-4F);
}

TEST(Picking, IgnoresMaskedBodiesAndBodiesAroundTheEye) {
  const Viewpoint viewpoint = viewpointFrom(Direction::front);
  const std::vector<Aabb> boxes = {cube({1000, 0, 20}, 10), cube({1000, 0, -20}, 10),
                                   cube({1000, 0, 0}, 1e5F)};
  EXPECT_EQ(pick(boxes, viewpoint, {200, 150}), 0U);
  const std::vector<std::uint8_t> mask = {0, 1, 1};
  EXPECT_EQ(pick(boxes, viewpoint, {200, 150}, mask), 1U);
}

TEST(Picking, AbsentBodiesAreNotHitNorSelected) {
  const Viewpoint viewpoint = viewpointFrom(Direction::front);
  const std::vector<Aabb> boxes = {kEmptyBox, cube({1000, 0, 20}, 10), kEmptyBox};
  EXPECT_EQ(pick(boxes, viewpoint, {200, 150}), 1U);
  EXPECT_EQ(pick({kEmptyBox}, viewpoint, {200, 150}), std::nullopt);
  for (const SelectBy by : {SelectBy::centre, SelectBy::whole}) {
    EXPECT_THAT(
        bodiesWithin(boxes, viewSpaceOf(kFarWorld), viewpoint, {{0, 0}, {400, 300}}, {}, by),
        testing::ElementsAre(1));
  }
}

TEST(Picking, NothingBehindTheEyeIsHit) {
  const Viewpoint viewpoint = viewpointFrom(Direction::front);
  EXPECT_EQ(pick({cube({1000, 0, 5000}, 10)}, viewpoint, {200, 150}), std::nullopt);
}

TEST(Picking, FlatAndTinyBodiesCanBeHit) {
  const Viewpoint viewpoint = viewpointFrom(Direction::front);
  const Aabb point = cube({1013, 7, 3}, 0);
  const Aabb plate{{990, 0, -10, 0}, {1010, 0, 10, 0}};  // seen edge-on
  const Aabb speck = cube({980, 20, 0}, 0.001F);
  const std::vector<Aabb> boxes = {point, plate, speck};
  for (std::uint32_t body = 0; body < boxes.size(); ++body) {
    const std::array at = screenPixelOf(viewpoint, middle(boxes[body]));
    EXPECT_EQ(pick(boxes, viewpoint, at), body);
    EXPECT_EQ(pick(boxes, viewpoint, {at[0], at[1] + 1.8F}), body);
    EXPECT_EQ(pick(boxes, viewpoint, {at[0], at[1] + 4}), std::nullopt);
    EXPECT_EQ(pick(boxes, viewpoint, {at[0], at[1] + 1.8F}, {}, 0.5F), std::nullopt);
  }
  EXPECT_EQ(pick(boxes, viewpoint, screenPixelOf(viewpoint, {1009, 0, 0, 0})), 1U);
}

TEST(Selecting, TakesTheBodiesWhoseMiddleIsInTheRectangle) {
  const Viewpoint viewpoint = viewpointFrom(Direction::figure);
  std::mt19937 bits(5);
  const auto random = [&] { return static_cast<float>(bits() % 1000) / 10 - 50; };
  std::vector<Aabb> boxes;
  for (int i = 0; i < 500; ++i) boxes.push_back(cube({1000 + random(), random(), random()}, 6));
  std::vector<std::uint32_t> expected;
  std::vector<std::uint32_t> expected_whole;
  const auto is_within = [&](const std::array<float, 4>& point) {
    const auto [x, y] = screenPixelOf(viewpoint, point);
    return x >= 120 && x <= 230 && y >= 90 && y <= 200;
  };
  for (std::uint32_t body = 0; body < boxes.size(); ++body) {
    if (is_within(middle(boxes[body]))) expected.push_back(body);
    bool whole = true;
    for (unsigned i = 0; i < 8; ++i) {
      const Aabb& box = boxes[body];
      whole =
          whole && is_within({i & 1U ? box.max[0] : box.min[0], i & 2U ? box.max[1] : box.min[1],
                              i & 4U ? box.max[2] : box.min[2], 0});
    }
    if (whole) expected_whole.push_back(body);
  }
  ASSERT_GT(expected.size(), 20U);
  ASSERT_GT(expected_whole.size(), 10U);
  const ViewSpace space = viewSpaceOf(kFarWorld);
  EXPECT_EQ(bodiesWithin(boxes, space, viewpoint, {{120, 90}, {230, 200}}), expected);
  EXPECT_EQ(bodiesWithin(boxes, space, viewpoint, {{230, 90}, {120, 200}}), expected);
  EXPECT_EQ(bodiesWithin(boxes, space, viewpoint, {{120, 90}, {230, 200}}, {}, SelectBy::whole),
            expected_whole);
}

TEST(Selecting, LeavesOutBodiesMaskedOrBehindTheEye) {
  const Viewpoint viewpoint = viewpointFrom(Direction::front);
  const std::vector<Aabb> boxes = {cube({1000, 0, 0}, 2), cube({1000, 0, 9}, 2),
                                   cube({1000, 0, 5000}, 2)};
  const ViewSpace space = viewSpaceOf(kFarWorld);
  const ScreenRectangle all{{0, 0}, {kScreenWidth, kScreenHeight}};
  EXPECT_THAT(bodiesWithin(boxes, space, viewpoint, all), ElementsAre(0, 1));
  const std::vector<std::uint8_t> mask = {0, 1, 1};
  EXPECT_THAT(bodiesWithin(boxes, space, viewpoint, all, mask), ElementsAre(1));
  EXPECT_THAT(bodiesWithin(boxes, space, viewpoint, {{0, 0}, {5, 5}}), IsEmpty());
}

}  // namespace
}  // namespace broadmark::tests
