// Swept boxes: exact bounds, absent bodies, changed bodies, in any order of frames.

#include "broadmark/recordings/swept_frames.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "engine/made_frames.h"
#include "support/changing_worlds.h"
#include "torture/inputs.h"

namespace broadmark::tests {
namespace {

using Boxes = std::vector<Aabb>;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::IsSupersetOf;

SweptFrames swept(const std::vector<Boxes>& frames, bool lists_changed = true) {
  return SweptFrames(std::make_unique<MadeFrames>(frames, lists_changed));
}

/// A unit box with minimum x.
Aabb at(float x) { return {{x, 0, 0, 0}, {x + 1, 1, 1, 0}}; }

/// From `low` to `high` on x, rounded outward.
Aabb around(float low, float high) {
  const float inf = std::numeric_limits<float>::infinity();
  const auto down = [&](float v) { return std::nextafter(v, -inf); };
  const auto up = [&](float v) { return std::nextafter(v, inf); };
  return {{down(low), down(0), down(0), 0}, {up(high), up(1), up(1), 0}};
}

/// Bodies that move, rest, appear and vanish.
std::vector<Boxes> restlessFrames(std::uint32_t n, std::uint32_t frames) {
  std::vector<Boxes> all;
  for (std::uint32_t frame = 0; frame < frames; ++frame) {
    Boxes boxes;
    for (std::uint32_t body = 0; body < n; ++body) {
      inputs::Random random(body, frame);
      if (random.integer(0, 4) == 0) {
        boxes.push_back(kEmptyBox);
      } else if (frame > 0 && random.integer(0, 1) == 0) {
        boxes.push_back(all.back()[body]);
      } else {
        boxes.push_back(at(static_cast<float>(random.integer(0, 3)) * 0.7F));
      }
    }
    all.push_back(std::move(boxes));
  }
  return all;
}

TEST(SweptFrames, HoldBothBoxesAndOneUnitInTheLastPlaceMore) {
  SweptFrames frames = swept({{at(0)}, {at(3)}, {at(3)}});
  EXPECT_EQ(frames.scene().name, "Made swept");
  EXPECT_EQ(frames.at(0).boxes[0], around(0, 1));
  EXPECT_EQ(frames.at(1).boxes[0], around(0, 4));
  EXPECT_EQ(frames.at(2).boxes[0], around(3, 4));
  EXPECT_EQ(frames.at(1).boxes[0], around(0, 4)) << "backwards";
}

TEST(SweptFrames, StayFinite) {
  constexpr float kLargest = std::numeric_limits<float>::max();
  const Aabb huge = {{-kLargest, -kLargest, -kLargest, 0}, {kLargest, kLargest, kLargest, 0}};
  EXPECT_EQ(sweptBox(huge, huge), huge);
}

TEST(SweptFrames, AnAbsentBodyHasNoBoxAndAnArrivingOneOnlyItsOwn) {
  SweptFrames frames = swept({{at(0)}, {kEmptyBox}, {at(5)}, {at(6)}});
  EXPECT_EQ(frames.at(1).boxes[0], kEmptyBox);
  EXPECT_EQ(frames.at(2).boxes[0], around(5, 6));
  EXPECT_EQ(frames.at(3).boxes[0], around(5, 7));
}

TEST(SweptFrames, ABodyThatStopsChangesOnceMore) {
  SweptFrames frames = swept({{at(0), at(9)}, {at(1), at(9)}, {at(1), at(9)}, {at(1), at(9)}});
  EXPECT_THAT(*frames.at(0).changed, IsEmpty());
  EXPECT_THAT(*frames.next()->changed, ElementsAre(0));
  EXPECT_THAT(*frames.next()->changed, ElementsAre(0));
  EXPECT_THAT(*frames.next()->changed, IsEmpty());
}

TEST(SweptFrames, TwoFramesAlikeInTheirUnionChangeNothing) {
  SweptFrames frames = swept({{at(0)}, {at(1)}, {at(0)}});
  frames.at(1);
  EXPECT_THAT(*frames.next()->changed, IsEmpty());
}

TEST(SweptFrames, AreTheSameInAnyOrderAndWhetherChangesAreKnownOrNot) {
  const auto made = restlessFrames(50, 9);
  const auto expected = [&](std::uint32_t index, std::uint32_t body) {
    return sweptBox(made[index - std::min(index, 1U)][body], made[index][body]);
  };
  SweptFrames with_changes = swept(made, true);
  SweptFrames without_changes = swept(made, false);
  for (const std::uint32_t index : {0, 1, 2, 3, 8, 2, 2, 3, 1, 7, 8, 0, 5, 6}) {
    const Frame frame = with_changes.at(index);
    const Frame other = without_changes.at(index);
    std::vector<std::uint32_t> changed;
    for (std::uint32_t body = 0; body < 50; ++body) {
      EXPECT_EQ(frame.boxes[body], expected(index, body)) << index << ' ' << body;
      EXPECT_EQ(other.boxes[body], expected(index, body)) << index << ' ' << body;
      if (index > 0 && expected(index, body) != expected(index - 1, body)) changed.push_back(body);
    }
    EXPECT_THAT(*frame.changed, testing::ElementsAreArray(changed)) << index;
    EXPECT_FALSE(other.changed);
  }
}

TEST(SweptFrames, HaveTheFilterOfTheirFrame) {
  const auto made = restlessFrames(20, 6);
  const auto filters = inputs::changingFilters({}, 20, 5, inputs::filter_changes::half, 1);
  inputs::GivenFrames given(inputs::sceneOf(made), made, filters);
  SweptFrames frames(std::make_unique<FrameList>(given));
  EXPECT_TRUE(frames.scene().filter_changes);
  for (const std::uint32_t index : {0, 1, 2, 5, 5, 3, 0}) {
    EXPECT_EQ(*frames.at(index).filter, filters[index]) << index;
  }
}

TEST(SweptFrames, PairsIncludeThoseOfBothFrames) {
  const auto made = restlessFrames(60, 6);
  SweptFrames frames = swept(made);
  const auto pairs = [&](std::span<const Aabb> boxes) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> all;
    for (std::uint32_t b = 0; b < boxes.size(); ++b) {
      for (std::uint32_t a = 0; a < b; ++a) {
        if (overlaps(boxes[a], boxes[b])) all.emplace_back(a, b);
      }
    }
    return all;
  };
  for (std::uint32_t index = 1; index < made.size(); ++index) {
    Boxes before = made[index - 1];
    for (std::size_t body = 0; body < before.size(); ++body) {
      if (isEmpty(made[index][body])) before[body] = kEmptyBox;  // vanished: no swept box
    }
    const auto found = pairs(frames.at(index).boxes);
    EXPECT_THAT(found, IsSupersetOf(pairs(made[index])));
    EXPECT_THAT(found, IsSupersetOf(pairs(before)));
  }
}

TEST(SweptFrames, ASingleFrameIsOnlyRounded) {
  SweptFrames frames = swept({{at(2)}});
  EXPECT_EQ(frames.rewind().boxes[0], around(2, 3));
  EXPECT_FALSE(frames.next());
}

}  // namespace
}  // namespace broadmark::tests
