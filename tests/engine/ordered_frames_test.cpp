// Bodies in another order: the same boxes, changes and filters, under other ids.

#include "broadmark/recordings/ordered_frames.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadmark/recordings/recording.h"
#include "engine/made_frames.h"
#include "support/changing_worlds.h"
#include "torture/inputs.h"

namespace broadmark::tests {
namespace {

using Boxes = std::vector<Aabb>;
using testing::ElementsAre;
using testing::ElementsAreArray;

constexpr std::uint32_t kOrderedBodies = 60;
constexpr std::uint32_t kFrames = 7;

/// Distinct boxes, of which some are absent for a time.
std::vector<Boxes> changingBoxes() {
  return framesWith({"drifting", inputs::drifting}, kOrderedBodies, kFrames, presences::random);
}

/// The source's ids by new id, from a frame in which all bodies are present.
std::vector<std::uint32_t> sourceIds(BodyOrder order) {
  const Boxes boxes = inputs::drifting(kOrderedBodies, 0, 1 + kOrderedBodies);
  OrderedFrames frames(std::make_unique<MadeFrames>(std::vector<Boxes>{boxes}, true), order);
  std::vector<std::uint32_t> ids;
  for (const Aabb& box : frames.at(0).boxes) {
    ids.push_back(static_cast<std::uint32_t>(std::ranges::find(boxes, box) - boxes.begin()));
  }
  return ids;
}

TEST(OrderedFrames, HoldTheSameBoxesInAnyOrderOfFrames) {
  const auto made = changingBoxes();
  const std::vector<std::uint32_t> ids = sourceIds(BodyOrder::random);
  OrderedFrames with_changes(std::make_unique<MadeFrames>(made, true), BodyOrder::random);
  OrderedFrames without_changes(std::make_unique<MadeFrames>(made, false), BodyOrder::random);
  EXPECT_EQ(with_changes.scene().name, "Made reordered");
  for (const std::uint32_t index : {0, 1, 2, 3, 6, 2, 2, 3, 1, 0, 5, 6}) {
    const Frame frame = with_changes.at(index);
    Boxes expected;
    std::vector<std::uint32_t> changed;
    for (std::uint32_t id = 0; id < kOrderedBodies; ++id) {
      expected.push_back(made[index][ids[id]]);
      if (index > 0 && made[index][ids[id]] != made[index - 1][ids[id]]) changed.push_back(id);
    }
    EXPECT_THAT(frame.boxes, ElementsAreArray(expected)) << index;
    EXPECT_THAT(*frame.changed, ElementsAreArray(changed)) << index;
    const Frame other = without_changes.at(index);
    EXPECT_THAT(other.boxes, ElementsAreArray(expected)) << index;
    EXPECT_FALSE(other.changed);
  }
}

TEST(OrderedFrames, FollowTheFiltersOfTheirBodies) {
  const auto made = changingBoxes();
  const auto filters =
      inputs::changingFilters({}, kOrderedBodies, kFrames - 1, inputs::filter_changes::few, 1);
  SceneInfo scene = inputs::sceneOf(made);
  scene.all_present = false;
  inputs::GivenFrames given(scene, made, filters);
  RecordingWriter writer(given.scene());
  recordAll(given, writer);
  OrderedFrames frames(writer.finishTemporary(), BodyOrder::random);
  const std::vector<std::uint32_t> ids = sourceIds(BodyOrder::random);
  EXPECT_EQ(frames.scene().filter, filters[0].of(ids));
  for (const std::uint32_t index : {0, 1, 2, 6, 3, 4}) {
    const Frame frame = frames.at(index);
    EXPECT_EQ(*frame.filter, filters[index].of(ids)) << index;
    std::vector<std::uint32_t> changed;
    for (std::uint32_t id = 0; index > 0 && id < kOrderedBodies; ++id) {
      if (filters[index].groupsOf(ids[id]) != filters[index - 1].groupsOf(ids[id])) {
        changed.push_back(id);
      }
    }
    EXPECT_THAT(frame.filter_changed, ElementsAreArray(changed)) << index;
  }
}

TEST(OrderedFrames, AreShuffledOrAlongAMortonCurve) {
  std::vector<std::uint32_t> shuffled = sourceIds(BodyOrder::random);
  EXPECT_FALSE(std::ranges::is_sorted(shuffled));
  std::ranges::sort(shuffled);
  for (std::uint32_t id = 0; id < kOrderedBodies; ++id) EXPECT_EQ(shuffled[id], id);

  // Corners of a cube and its centre, the last first; absent bodies and one that repeats.
  Boxes boxes = {kEmptyBox};
  for (int corner = 8; corner-- > 0;) {
    const auto at = [&](int axis) { return (corner >> axis & 1) == 0 ? -1e30F : 1e30F; };
    boxes.push_back({{at(0), at(1), at(2), 0}, {at(0), at(1), at(2), 0}});
  }
  boxes.push_back(boxes[8]);
  boxes.push_back({{-1, -1, -1, 0}, {0, 0, 0, 0}});
  OrderedFrames frames(std::make_unique<MadeFrames>(std::vector<Boxes>{boxes, boxes}, true),
                       BodyOrder::morton);
  std::vector<std::ptrdiff_t> order;
  for (const Aabb& box : frames.at(1).boxes) {
    order.push_back(std::ranges::find(boxes, box) - boxes.begin());
  }
  EXPECT_THAT(order, ElementsAre(8, 8, 10, 7, 6, 5, 4, 3, 2, 1, 0));
}

}  // namespace
}  // namespace broadmark::tests
