// Periodic worlds: wrapped boxes, their images, the right pairs by two methods, and frames.

#include "broadmark/periodic_box.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "broadmark/error.h"
#include "broadmark/recordings/adapted_frames.h"
#include "broadmark/reference_pairs.h"
#include "engine/made_frames.h"
#include "torture/inputs.h"

namespace broadmark::tests {
namespace {

using Boxes = std::vector<Aabb>;

using testing::ElementsAre;
using testing::HasSubstr;

const PeriodicBox kTen{{0, 0, 0}, {10, 10, 10}};

Aabb onX(float low, float high) { return {{low, 4, 4, 0}, {high, 5, 5, 0}}; }

std::string messageOf(const std::function<void()>& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(PeriodicBox, IsReadFromItsText) {
  const PeriodicBox box = parsePeriodic("0:10,-,-2.5:1e3");
  EXPECT_EQ(box, (PeriodicBox{{0, 0, -2.5}, {10, 0, 1000}}));
  EXPECT_FALSE(box.repeats(1));
  EXPECT_EQ(parsePeriodic(periodicText(box)), box);
  for (const char* text :
       {"", "-,-,-", "0:1", "0:1,0:1", "0:1,0:1,0:1,0:1", "1:0,-,-", "1:1,-,-", "0:x,-,-", "0,-,-",
        "0:1:2,-,-", "nan:1,-,-", "0:inf,-,-", "-1e40:0,-,-", " 0:1,-,-", "0:1,-,- "}) {
    EXPECT_THAT(messageOf([&] { parsePeriodic(text); }), HasSubstr("is not a periodic box"))
        << text;
  }
}

TEST(PeriodicBox, TakesBoxesToTheirImageWithin) {
  EXPECT_EQ(wrapped(onX(3, 4), kTen), onX(3, 4));
  EXPECT_EQ(wrapped(onX(9.5F, 11), kTen), onX(9.5F, 11)) << "may protrude at the upper face";
  EXPECT_EQ(wrapped(onX(-0.5F, 1), kTen), onX(9.5F, 11));
  EXPECT_EQ(wrapped(onX(10, 11), kTen), onX(0, 1));
  EXPECT_EQ(wrapped(onX(-35, -34), kTen), onX(5, 6));
  EXPECT_EQ(wrapped(onX(1e6F, 1e6F + 2), kTen), onX(0, 2));
  EXPECT_EQ(wrapped(kEmptyBox, kTen), kEmptyBox);
  EXPECT_EQ(wrapped(onX(-35, 99), PeriodicBox{{0, 0, 0}, {0, 10, 10}}), onX(-35, 99));
  EXPECT_THAT(messageOf([] { wrapped(onX(3e7F, 3e7F), kTen); }),
              HasSubstr("begins 3e+06 periods from the periodic box along x"));
}

TEST(PeriodicBox, RoundsImagesOutward) {
  const PeriodicBox third{{0, 0, 0}, {1.0 / 3, 0, 0}};
  for (std::uint32_t seed = 0; seed < 5000; ++seed) {
    inputs::Random random(seed, 0);
    const float low = random.uniform(-50, 50);
    const Aabb box = wrapped({{low, 0, 0, 0}, {low + 0.1F, 0, 0, 0}}, third);
    // Long doubles hold the products and sums exactly.
    const long double shift = std::round((static_cast<long double>(low) - box.min[0]) * 3);
    const long double exact = low - shift * (1.0 / 3);
    EXPECT_LE(box.min[0], exact) << seed;
    EXPECT_GT(std::nextafter(box.min[0], 1.0F), exact) << seed;
    EXPECT_GE(box.max[0], low + 0.1F - shift * (1.0 / 3)) << seed;
    EXPECT_GE(exact, 0) << seed;
    EXPECT_LT(exact, 1.0L / 3) << seed;
  }
}

TEST(PeriodicBox, PairsMeetAcrossFacesEdgesAndCorners) {
  const auto meet = [](const Aabb& a, const Aabb& b) {
    EXPECT_EQ(overlaps(a, b, kTen), overlaps(b, a, kTen));
    return overlaps(a, b, kTen);
  };
  EXPECT_TRUE(meet(onX(9.5F, 10.5F), onX(0.25F, 1)));
  EXPECT_TRUE(meet(onX(9.5F, 10), onX(0, 1))) << "touching counts";
  EXPECT_FALSE(meet(onX(9.5F, 9.99F), onX(0, 1)));
  EXPECT_TRUE(meet(onX(5, 18), onX(0, 1))) << "longer than the box";
  EXPECT_FALSE(meet(onX(9.5F, 10.5F), kEmptyBox));
  const Aabb corner{{9.5F, 9.5F, 9.5F, 0}, {10.5F, 10.5F, 10.5F, 0}};
  EXPECT_TRUE(meet(corner, {{0, 0, 0, 0}, {1, 1, 1, 0}}));
  EXPECT_TRUE(meet(corner, {{0, 9, 0, 0}, {1, 9.7F, 1, 0}}));
  // One of them protrudes along x, the other one along y.
  EXPECT_TRUE(meet({{9.5F, 0, 4, 0}, {10.5F, 1, 5, 0}}, {{0, 9.5F, 4, 0}, {1, 10.5F, 5, 0}}));
}

/// On a grid of eighths all sums are exact: the definition, image by image.
TEST(PeriodicBox, PairsAreThoseOfAnyImages) {
  for (std::uint32_t seed = 0; seed < 300; ++seed) {
    inputs::Random random(seed, 0);
    const PeriodicBox periodic{{0, 0, 0},
                               {2, random.integer(0, 1) * 3.0, random.integer(0, 2) * 1.5}};
    const float longest = random.onceIn(3) ? 40 : 6;
    Boxes boxes;
    for (int i = 0; i < 40; ++i) {
      Aabb box;
      for (int axis = 0; axis < 3; ++axis) {
        box.min[axis] = static_cast<float>(random.integer(-60, 60)) / 8;
        box.max[axis] =
            box.min[axis] + static_cast<float>(random.integer(0, static_cast<int>(longest))) / 8;
      }
      boxes.push_back(random.onceIn(10) ? kEmptyBox : box);
    }
    const auto meet = [&](const Aabb& a, const Aabb& b) {
      if (isEmpty(a) || isEmpty(b)) return false;
      for (int axis = 0; axis < 3; ++axis) {
        bool found = false;
        for (int shift = periodic.repeats(axis) ? -40 : 0;
             shift <= (periodic.repeats(axis) ? 40 : 0); ++shift) {
          const double by = shift * periodic.period(axis);
          found |= a.min[axis] + by <= b.max[axis] && b.min[axis] <= a.max[axis] + by;
        }
        if (!found) return false;
      }
      return true;
    };
    std::vector<Pair> expected;
    for (std::uint32_t a = 0; a < boxes.size(); ++a) {
      for (std::uint32_t b = a + 1; b < boxes.size(); ++b) {
        if (meet(boxes[a], boxes[b])) expected.push_back({a, b});
      }
    }
    for (Aabb& box : boxes) box = wrapped(box, periodic);
    EXPECT_EQ(bruteForcePairs(boxes, {}, periodic), expected) << seed;
    EXPECT_EQ(sweptPairs(boxes, {}, periodic), expected) << seed;
  }
}

TEST(PeriodicBox, TwoMethodsFindTheSamePairs) {
  for (std::uint32_t seed = 0; seed < 100; ++seed) {
    inputs::Random random(seed, 1);
    const PeriodicBox periodic{{-0.1, 0.3, 0}, {0.9, random.onceIn(2) ? 1.1 : 0, 0.7}};
    Boxes boxes;
    for (int i = 0; i < 150; ++i) {
      const inputs::Vec3 edges = {random.uniform(0, 0.2F), random.uniform(0, 0.2F),
                                  random.onceIn(9) ? 2.0F : 0.1F};
      boxes.push_back(wrapped(inputs::boxAt(random.inCube(3), edges), periodic));
    }
    EXPECT_EQ(bruteForcePairs(boxes, {}, periodic), sweptPairs(boxes, {}, periodic)) << seed;
  }
}

TEST(PeriodicFrames, AreWrapped) {
  const std::vector<Boxes> made = {{onX(9, 10), onX(2, 3)}, {onX(10, 11), onX(12, 13)}};
  const auto frames = [&] { return std::make_unique<MadeFrames>(made, true); };
  const ParameterValues reading = {{"periodic", "0:10,-,-"}};
  const auto periodic = adapted(frames(), reading);
  EXPECT_EQ(periodic->scene().name, "Made periodic");
  EXPECT_EQ(periodic->scene().world.max[0], 10);
  EXPECT_EQ(periodic->scene(), adaptedScene(MadeFrames(made, true).scene(), reading));
  EXPECT_EQ(unadaptedName(periodic->scene().name, reading), "Made");
  const Frame frame = periodic->at(1);
  EXPECT_THAT(frame.boxes, ElementsAre(onX(0, 1), onX(2, 3)));
  EXPECT_THAT(*frame.changed, ElementsAre(0)) << "a whole period is no change";
}

TEST(PeriodicFrames, NeedABoxAndNoSweep) {
  const std::vector<Boxes> made = {{onX(9, 10)}, {onX(1e9F, 1e9F)}};
  const auto error = [&](const ParameterValues& reading) {
    return messageOf([&] { adapted(std::make_unique<MadeFrames>(made, true), reading)->at(1); });
  };
  EXPECT_THAT(error({{"periodic", "source"}}), HasSubstr("states no periodic box: give it, as in"));
  EXPECT_THAT(error({{"periodic", "0:10"}}), HasSubstr("'0:10' is not a periodic box"));
  EXPECT_THAT(error({{"periodic", "0:10,-,-"}, {"swept", "on"}}), HasSubstr("not both"));
  EXPECT_EQ(error({{"periodic", "0:10,-,-"}}),
            "Made: frame 1, body 0: its box begins 1e+08 periods from the periodic box along x: at "
            "most 1000000 are expected");
}

}  // namespace
}  // namespace broadmark::tests
