#include "inspector/views/glass.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/drawing.h"

namespace broadmark::tests {
namespace {

using testing::ElementsAre;

const Point kEye = {0, 0, 20};

std::vector<std::uint8_t> glassOf(const std::vector<Aabb>& boxes,
                                  const std::vector<std::uint32_t>& focus) {
  return glassBefore(boxes, focus, kEye);
}

TEST(Glass, IsWhatHidesTheBodyOrCouldBeCut) {
  EXPECT_THAT(glassOf({cube({0, 0, 0}, 2),     // in focus
                       cube({0, 0, 7}, 2),     // between the eye and it
                       cube({6, 0, 7}, 2),     // beside the line of sight
                       cube({0, 0, -7}, 2),    // behind it
                       cube({2.1F, 0, 0}, 2),  // close to it
                       cube({5, 0, 18}, 2),    // close to the eye
                       kEmptyBox},             // absent
                      {0}),
              ElementsAre(0, 1, 0, 0, 1, 1, 0));
}

TEST(Glass, IsSeenThroughForEachOfTwo) {
  const std::vector<Aabb> boxes = {cube({-6, 0, 0}, 2), cube({6, 0, 0}, 2), cube({-4, 0, 7}, 2),
                                   cube({4, 0, 7}, 2), cube({0, 0, 7}, 2)};
  EXPECT_THAT(glassOf(boxes, {0, 1}), ElementsAre(0, 0, 1, 1, 0));
  EXPECT_THAT(glassOf(boxes, {0}), ElementsAre(0, 0, 1, 0, 0));
}

TEST(Glass, IsNothingWithoutABodyInFocus) {
  EXPECT_TRUE(glassOf({cube({0, 0, 0}, 2)}, {}).empty());
  EXPECT_TRUE(glassOf({kEmptyBox, cube({0, 0, 7}, 2)}, {0}).empty());
}

}  // namespace
}  // namespace broadmark::tests
