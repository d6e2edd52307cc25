// Parts of recordings: correct boxes, from any kind of source, in any order.

#include "broadmark/recordings/sub_recording.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadmark/recordings/recording.h"
#include "engine/helpers.h"
#include "support/changing_worlds.h"
#include "support/wandering_boxes.h"

namespace broadmark::tests {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::vector<Aabb> copyOf(const Frame& frame) { return {frame.boxes.begin(), frame.boxes.end()}; }

std::unique_ptr<Recording> recorded(FrameSource& source) {
  RecordingWriter writer(source.scene());
  recordAll(source, writer);
  return writer.finishTemporary();
}

TEST(IndexedFrames, GiveTheirFramesInAnyOrder) {
  WanderingBoxes live(5, 9, 1);
  WanderingBoxes again(5, 9, 1);
  const auto recording = recorded(again);
  FrameList list(live);
  std::vector<std::vector<Aabb>> all;
  WanderingBoxes third(5, 9, 1);
  recordAll(third, [&](const Frame& frame) { all.push_back(copyOf(frame)); });
  for (const std::uint32_t index : {3U, 9U, 0U, 0U, 4U, 5U, 2U, 9U}) {
    for (IndexedFrames* frames : std::initializer_list<IndexedFrames*>{&list, recording.get()}) {
      const Frame frame = frames->at(index);
      EXPECT_EQ(frame.index, index);
      EXPECT_EQ(copyOf(frame), all[index]);
    }
  }
  EXPECT_THAT(inputErrorOf([&] { list.at(10); }), HasSubstr("no frame 10"));
  EXPECT_THAT(inputErrorOf([&] { recording->at(10); }), HasSubstr("no frame 10"));
  EXPECT_EQ(copyOf(list.at(1)), all[1]);
  EXPECT_EQ(copyOf(*list.next()), all[2]) << "next() continues after at()";
}

TEST(SubRecording, IsTheSelectedPart) {
  WanderingBoxes source(6, 8, 2);
  FrameList whole(source);
  FrameList check(source);
  const Selection selected{{1, 4, 5}, {2, 3, 7}};
  SubRecording part(whole, selected, "Part");
  EXPECT_EQ(part.scene().name, "Part");
  EXPECT_EQ(part.scene().object_type, source.scene().object_type);
  EXPECT_EQ(part.scene().world, source.scene().world);
  EXPECT_EQ(part.scene().objects, 3U);
  EXPECT_EQ(part.scene().frames, 2U);
  for (int pass = 0; pass < 2; ++pass) {
    std::uint32_t index = 0;
    for (std::optional<Frame> frame = part.rewind(); frame; frame = part.next()) {
      EXPECT_EQ(frame->index, index);
      const std::vector<Aabb> all = copyOf(check.at(selected.frames.at(index)));
      EXPECT_THAT(copyOf(*frame), ElementsAre(all[1], all[4], all[5]));
      ++index;
    }
    EXPECT_EQ(index, 3U);
  }
}

TEST(SubRecording, OfEverythingIsTheWhole) {
  WanderingBoxes source(7, 4, 3);
  const auto recording = recorded(source);
  SubRecording part(*recording, selectAll(recording->scene(), 4), recording->scene().name);
  EXPECT_EQ(part.scene(), recording->scene());
  EXPECT_EQ(recorded(part)->hash(), recording->hash());
}

TEST(SubRecording, FillsAbsencesAndKeepsTheFilterOfItsBodies) {
  WanderingBoxes live(4, 5, 2);
  const std::vector<BodyGroups> groups = {{.layer = 1}, {.layer = 2}, {.world = 3}, {.layer = 4}};
  FrameList whole = changing(
      live, [](std::uint32_t body, std::uint32_t frame) { return body != 2 || frame > 3; },
      CollisionFilter(groups, LayerMatrix().set(0, 4)));
  Selection some = selectionOf(whole.scene(), {1, 2, 3}, {0, 2, 4});
  EXPECT_FALSE(some.all_present);
  EXPECT_EQ(some.filter.groupsOf(1), groups[2]);
  EXPECT_EQ(some.filter.matrix(), whole.scene().filter.matrix());
  const Aabb filling = inputs::boxAt({7, 7, 7}, {1, 1, 1});
  some.filled = {{2, 2, 3, filling}};
  SubRecording part(whole, some, "Part");
  EXPECT_FALSE(part.scene().all_present);
  EXPECT_EQ(part.scene().filter, some.filter);
  EXPECT_TRUE(isEmpty(part.at(0).boxes[1]));
  EXPECT_EQ(part.at(1).boxes[1], filling);
  EXPECT_EQ(part.at(2).boxes[1], whole.at(4).boxes[2]);
  EXPECT_EQ(part.at(1).boxes[2], whole.at(2).boxes[3]);
}

TEST(SubRecording, FollowsTheFiltersOfItsBodies) {
  constexpr std::uint32_t kLast = 8;
  WanderingBoxes live(6, kLast, 2);
  FrameList boxes(live);
  const auto filters = inputs::changingFilters({}, 6, kLast, inputs::filter_changes::half, 3);
  std::vector<std::vector<Aabb>> frames;
  recordAll(boxes, [&](const Frame& frame) { frames.push_back(copyOf(frame)); });
  FrameList whole = listed(boxes.scene(), frames, filters);
  Selection some = selectionOf(whole.scene(), {1, 2, 5}, {3, 4, 8});
  EXPECT_EQ(some.filter_changes, some.bodies);
  const auto recorded_part = [&](const Selection& selected) {
    SubRecording part(whole, selected, "Part");
    EXPECT_EQ(part.scene().filter, part.at(0).filterIn(part.scene()));
    return recorded(part);
  };
  const auto part = recorded_part(some);
  EXPECT_TRUE(part->scene().filter_changes);
  for (const std::uint32_t index : {2U, 0U, 1U}) {
    EXPECT_EQ(*part->at(index).filter, filters[some.frames[index]].of(some.bodies));
  }
  // Body 2 keeps its own.
  some.filter_changes = {1, 5};
  some.filter = filters[8].of(some.bodies);
  const auto fixed = recorded_part(some);
  for (std::uint32_t index = 0; index < 3; ++index) {
    const CollisionFilter& filter = *fixed->at(index).filter;
    EXPECT_EQ(filter.groupsOf(0), filters[some.frames[index]].groupsOf(1));
    EXPECT_EQ(filter.groupsOf(1), filters[8].groupsOf(2));
  }
  some.filter_changes.clear();
  EXPECT_FALSE(recorded_part(some)->scene().filter_changes);
}

TEST(FrameList, HoldsAllFrames) {
  WanderingBoxes source(7, 4, 3);
  FrameList list(source);
  EXPECT_EQ(list.scene(), source.scene());
  EXPECT_EQ(recorded(list)->hash(), recorded(source)->hash());
}

}  // namespace
}  // namespace broadmark::tests
