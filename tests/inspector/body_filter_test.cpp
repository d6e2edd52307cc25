// The body filter: which bodies are drawn.
#include "inspector/session/display_options.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadmark/error.h"
#include "inspector/session/text_lists.h"

namespace broadmark::tests {
namespace {

using testing::ElementsAre;

Aabb cubeAt(float low, float side) {
  return {{low, low, low, 0}, {low + side, low + side, low + side, 0}};
}

class BodyFilterTest : public testing::Test {
 protected:
  std::vector<std::uint8_t> visible() const {
    std::vector<std::uint8_t> marks(boxes.size(), 1);
    hideBodies(filter,
               {.boxes = boxes, .layers = layers, .classes = classes, .world = cubeAt(0, 10)},
               marks);
    return marks;
  }

  std::vector<Aabb> boxes = {cubeAt(0, 1), cubeAt(4, 2), cubeAt(8, 0.5F)};
  std::vector<std::uint8_t> layers = {0, 31, 2};
  std::vector<std::uint8_t> classes = {1, 0, 1};
  BodyFilter filter;
};

TEST_F(BodyFilterTest, HidesNobodyAtFirst) {
  EXPECT_FALSE(filter.hides());
  EXPECT_THAT(visible(), ElementsAre(1, 1, 1));
}

TEST_F(BodyFilterTest, ByLayer) {
  filter.hidden_layers = 1U << 31;
  EXPECT_TRUE(filter.hides());
  EXPECT_THAT(visible(), ElementsAre(1, 0, 1));
  layers.clear();  // a scene without layers
  EXPECT_THAT(visible(), ElementsAre(1, 1, 1));
}

TEST_F(BodyFilterTest, ByColour) {
  filter.hidden_classes = 1U << 1;
  EXPECT_THAT(visible(), ElementsAre(0, 1, 0));
}

TEST_F(BodyFilterTest, BySize) {
  filter.smallest = 1;
  EXPECT_THAT(visible(), ElementsAre(1, 1, 0));
  filter.largest = 1;
  EXPECT_THAT(visible(), ElementsAre(1, 0, 0));
}

TEST_F(BodyFilterTest, ByAPlaneThatStandsInTheWorld) {
  filter.clip_axis = 1;
  filter.clip_at = 0.5;
  EXPECT_THAT(visible(), ElementsAre(1, 1, 0)) << "a centre on the plane stays";
  filter.clip_below = true;
  EXPECT_THAT(visible(), ElementsAre(0, 1, 1));
  const auto plane = clipPlane(filter, cubeAt(0, 10));
  ASSERT_TRUE(plane);
  EXPECT_EQ(plane->min[1], 5);
  EXPECT_EQ(plane->max[1], 5);
  EXPECT_EQ(plane->max[0], 10);
}

TEST(BodyIds, AreNumbersAndRanges) {
  EXPECT_THAT(parseIds("17, 3-5 9", "body", 20), ElementsAre(17, 3, 4, 5, 9));
  EXPECT_THAT(parseIds("", "body", 20), ElementsAre());
  EXPECT_THROW(parseIds("21", "body", 20), InputError);
  EXPECT_THROW(parseIds("3-x", "body", 20), InputError);
  EXPECT_THROW(parseIds("-3", "body", 20), InputError);
}

}  // namespace
}  // namespace broadmark::tests
