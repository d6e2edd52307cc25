// Widened boxes: exact bounds, rounded outward, at every magnitude; and the list of frame adapters.

#include "broadmark/recordings/widened_frames.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cfenv>
#include <cmath>
#include <limits>

#include "broadmark/error.h"
#include "broadmark/recordings/adapted_frames.h"
#include "broadmark/recordings/swept_frames.h"
#include "broadmark/reference_pairs.h"
#include "engine/made_frames.h"
#include "torture/inputs.h"

namespace broadmark::tests {
namespace {

using Boxes = std::vector<Aabb>;

using testing::ElementsAre;
using testing::IsEmpty;

constexpr float kLargestFloat = std::numeric_limits<float>::max();
constexpr float kTiniestFloat = std::numeric_limits<float>::denorm_min();
constexpr float kInfiniteFloat = std::numeric_limits<float>::infinity();

Aabb cube(float low, float high) { return {{low, low, low, 0}, {high, high, high, 0}}; }
Aabb onX(float low, float high) { return {{low, 0, 0, 0}, {high, 1, 1, 0}}; }

/// Whether bound + half <= limit, exactly. Long doubles have 64 bits: both terms are halved floats
/// or doubles of few bits here, so that most sums are exact; the difference of equals always is.
bool holds(float bound, double half, float limit) {
  const long double room = static_cast<long double>(limit) - bound;
  return room >= static_cast<long double>(half);
}

TEST(WidenedBox, GrowsByHalfTheDistanceOnEverySide) {
  const Aabb box = {{1, -2, 3, 0}, {4, 5, 6, 0}};
  EXPECT_EQ(widenedBox(box, 0.5), (Aabb{{0.75F, -2.25F, 2.75F, 0}, {4.25F, 5.25F, 6.25F, 0}}));
  EXPECT_EQ(widenedBox(box, 0), box);
  EXPECT_EQ(widenedBox(cube(7, 7), 2), cube(6, 8));
}

TEST(WidenedBox, IsTheSmallestAroundTheGrownOne) {
  for (std::uint32_t seed = 0; seed < 20'000; ++seed) {
    inputs::Random random(seed, 0);
    const auto number = [&](int low, int high) {
      const float mantissa = 1 + static_cast<float>(random.integer(0, (1 << 23) - 1)) * 0x1p-23F;
      return std::ldexp(mantissa, random.integer(low, high));
    };
    const float bound = random.integer(0, 1) == 0 ? number(-20, 20) : -number(-20, 20);
    const double distance = number(-20, 20);
    const Aabb widened = widenedBox(cube(bound, bound), distance);
    ASSERT_TRUE(holds(bound, distance / 2, widened.max[0])) << seed;
    ASSERT_FALSE(holds(bound, distance / 2, std::nextafter(widened.max[0], -kInfiniteFloat)))
        << seed;
    ASSERT_TRUE(holds(-bound, distance / 2, -widened.min[0])) << seed;
    ASSERT_FALSE(holds(-bound, distance / 2, -std::nextafter(widened.min[0], kInfiniteFloat)))
        << seed;
  }
}

TEST(WidenedBox, MeetsAnotherAtExactlyTheDistance) {
  const float edge = 0.1F;
  for (const float distance : {1.0F, 0.3F, 1e-3F, 777.7F, 1e20F}) {
    // The gap of these two is the distance exactly: no rounding in their difference.
    const float far = distance;
    const auto meet = [&](float x) {
      return overlaps(widenedBox(onX(-edge, 0), distance), widenedBox(onX(x, x + edge), distance));
    };
    EXPECT_TRUE(meet(far)) << distance;
    EXPECT_TRUE(meet(far / 2)) << distance;
    EXPECT_FALSE(
        meet(std::nextafter(std::nextafter(far, kInfiniteFloat), kInfiniteFloat) * 1.0001F))
        << distance;
  }
  EXPECT_FALSE(overlaps(widenedBox(onX(0, 1), 0.5), widenedBox(onX(1.5000001F, 2), 0.5)));
}

TEST(WidenedBox, OfAnAbsentBodyIsEmpty) {
  EXPECT_EQ(widenedBox(kEmptyBox, 1), kEmptyBox);
  EXPECT_EQ(widenedBox(kEmptyBox, kMaxWidening), kEmptyBox);
}

TEST(WidenedBox, StaysFiniteAndKeepsThePairs) {
  const Aabb huge = cube(-kLargestFloat, kLargestFloat);
  EXPECT_EQ(widenedBox(huge, 1), huge);
  EXPECT_EQ(widenedBox(huge, kMaxWidening), huge);
  EXPECT_EQ(widenedBox(cube(3.4028e38F, kLargestFloat), kMaxWidening).max[0], kLargestFloat);
  // Two corners of the world of floats: as far apart as boxes can be.
  const Aabb low = widenedBox(cube(-kLargestFloat, -kLargestFloat), kMaxWidening);
  const Aabb high = widenedBox(cube(kLargestFloat, kLargestFloat), kMaxWidening);
  EXPECT_FALSE(overlaps(low, high));
  EXPECT_TRUE(overlaps(high, widenedBox(cube(kLargestFloat, kLargestFloat), 0)));
  EXPECT_LT(high.min[0], kLargestFloat);
}

TEST(WidenedBox, RoundsOutwardWhatIsLostOtherwise) {
  // Distances far below the resolution of the bounds.
  for (const double distance :
       {1e-30, double{kTiniestFloat}, std::numeric_limits<double>::denorm_min()}) {
    const Aabb widened = widenedBox(cube(1, 2), distance);
    EXPECT_EQ(widened.min[0], std::nextafter(1.0F, 0.0F)) << distance;
    EXPECT_EQ(widened.max[0], std::nextafter(2.0F, 3.0F)) << distance;
    const Aabb around_zero = widenedBox(cube(0, 0), distance);
    EXPECT_LT(around_zero.min[0], 0) << distance;
    EXPECT_GT(around_zero.max[0], 0) << distance;
  }
  EXPECT_EQ(widenedBox(cube(kTiniestFloat, kTiniestFloat), 2.0 * kTiniestFloat),
            cube(0, 2 * kTiniestFloat));
  EXPECT_EQ(widenedBox(cube(-kTiniestFloat, kTiniestFloat), kTiniestFloat),
            cube(-2 * kTiniestFloat, 2 * kTiniestFloat));
}

TEST(WidenedFrames, NameThemselvesAndWidenTheirWorld) {
  const auto frames =
      widened(std::make_unique<MadeFrames>(std::vector<Boxes>{{onX(0, 1)}}, true), 2);
  EXPECT_EQ(frames->scene().name, "Made widened");
  EXPECT_EQ(frames->scene().world, cube(-1, 1));
  EXPECT_EQ(frames->rewind().boxes[0], (Aabb{{-1, -1, -1, 0}, {2, 2, 2, 0}}));
  EXPECT_FALSE(frames->next());
}

TEST(WidenedFrames, ListTheBodiesWhoseWidenedBoxesChange) {
  const float step = std::nextafter(1.0F, 2.0F);
  const std::vector<Boxes> made = {{onX(0, 1), onX(5, 6), onX(8, 9)},
                                   {onX(0, step), onX(5, 6), kEmptyBox},
                                   {onX(0, 1), onX(6, 7), kEmptyBox},
                                   {onX(0, 1), onX(6, 7), onX(8, 9)}};
  const auto frames = widened(std::make_unique<MadeFrames>(made, true), 1e9);
  EXPECT_THAT(*frames->rewind().changed, IsEmpty());
  EXPECT_THAT(*frames->next()->changed, ElementsAre(2)) << "body 0's step is lost in rounding";
  EXPECT_THAT(*frames->next()->changed, IsEmpty()) << "so is a unit at this distance";
  EXPECT_THAT(*frames->next()->changed, ElementsAre(2));
  EXPECT_THAT(*frames->at(1).changed, ElementsAre(2)) << "backwards";
  EXPECT_THAT(*frames->at(3).changed, ElementsAre(2)) << "after a leap";
  const auto near = widened(std::make_unique<MadeFrames>(made, true), 0.5);
  EXPECT_THAT(*near->at(2).changed, ElementsAre(0, 1));
  const auto unknown = widened(std::make_unique<MadeFrames>(made, false), 0.5);
  for (std::uint32_t index : {0, 2, 1, 3}) {
    const Frame frame = unknown->at(index);
    EXPECT_FALSE(frame.changed);
    for (std::size_t body = 0; body < 3; ++body) {
      EXPECT_EQ(frame.boxes[body], widenedBox(made[index][body], 0.5));
    }
  }
}

TEST(WidenedFrames, PairsAreThoseNoFartherApart) {
  // On a grid of quarters every gap is exact.
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    inputs::Random random(seed, 1);
    Boxes boxes;
    for (int i = 0; i < 60; ++i) {
      Aabb box;
      for (int axis = 0; axis < 3; ++axis) {
        box.min[axis] = static_cast<float>(random.integer(0, 40)) / 4;
        box.max[axis] = box.min[axis] + static_cast<float>(random.integer(0, 6)) / 4;
      }
      boxes.push_back(random.integer(0, 9) == 0 ? kEmptyBox : box);
    }
    const double distance = random.integer(0, 12) / 4.0;
    std::vector<Pair> expected;
    for (std::uint32_t a = 0; a < boxes.size(); ++a) {
      for (std::uint32_t b = a + 1; b < boxes.size(); ++b) {
        if (isEmpty(boxes[a]) || isEmpty(boxes[b])) continue;
        double gap = 0;
        for (int axis = 0; axis < 3; ++axis) {
          gap = std::max({gap, double{boxes[b].min[axis]} - boxes[a].max[axis],
                          double{boxes[a].min[axis]} - boxes[b].max[axis]});
        }
        if (gap <= distance) expected.push_back({a, b});
      }
    }
    const auto frames =
        widened(std::make_unique<MadeFrames>(std::vector<Boxes>{boxes}, true), distance);
    EXPECT_EQ(bruteForcePairs(frames->rewind().boxes), expected) << seed;
  }
}

TEST(AdaptedFrames, ApplyInTheOrderOfTheListAndOnlyIfAsked) {
  const std::vector<Boxes> made = {{onX(0, 1)}, {onX(4, 5)}};
  const auto frames = [&] { return std::make_unique<MadeFrames>(made, true); };
  const ParameterValues both = {{"radius", "2"}, {"swept", "on"}, {"widen", "0.5"}};
  EXPECT_EQ(adaptersIn(both), (ParameterValues{{"swept", "on"}, {"widen", "0.5"}}));
  EXPECT_EQ(adapted(frames(), {{"radius", "2"}})->scene().name, "Made");

  const auto twice = adapted(frames(), both);
  EXPECT_EQ(twice->scene().name, "Made swept widened");
  EXPECT_EQ(twice->scene(), adaptedScene(MadeFrames(made, true).scene(), both));
  EXPECT_EQ(unadaptedName(twice->scene().name, both), "Made");
  EXPECT_EQ(twice->at(1).boxes[0], widenedBox(sweptBox(made[0][0], made[1][0]), 0.5));

  SceneInfo long_name;
  long_name.name = std::string(kMaxNameLength, 'x');
  EXPECT_EQ(adaptedScene(long_name, both).name.size(), kMaxNameLength);
}

TEST(AdaptedFrames, HaveAHashOfTheirOwn) {
  const std::string hash(32, '0');
  std::vector<std::string> hashes = {adaptedHash(hash, {}),
                                     adaptedHash(hash, {{"swept", "on"}}),
                                     adaptedHash(hash, {{"widen", "1"}}),
                                     adaptedHash(hash, {{"widen", "2"}}),
                                     adaptedHash(hash, {{"swept", "on"}, {"widen", "1"}}),
                                     adaptedHash(std::string(32, '1'), {{"widen", "1"}})};
  EXPECT_EQ(hashes[0], hash);
  for (const std::string& one : hashes) EXPECT_EQ(one.size(), 32U);
  std::ranges::sort(hashes);
  EXPECT_TRUE(std::ranges::adjacent_find(hashes) == hashes.end());
}

}  // namespace
}  // namespace broadmark::tests
