// The explanation of a wrong pair.
#include "inspector/session/wrong_pair.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "inspector/session/mismatches.h"

namespace broadmark::tests {
namespace {

using Type = AxisRelation::Type;

Aabb box(float min, float max) { return {{min, 0, 0, 0}, {max, 1, 1, 0}}; }

TEST(AxisRelations, TellOverlapTouchAndGap) {
  EXPECT_EQ(axisRelation(0, box(0, 2), box(1, 3)).type, Type::overlap);
  EXPECT_EQ(axisRelation(0, box(0, 2), box(1, 3)).gap, -1);
  EXPECT_EQ(axisRelation(0, box(0, 2), box(2, 3)).type, Type::touch);
  EXPECT_EQ(axisRelation(0, box(4, 5), box(2, 3)).type, Type::gap);
  EXPECT_EQ(axisRelation(0, box(4, 5), box(2, 3)).gap, 1);
}

TEST(AxisRelations, NeighbouringFloatsDoNotTouch) {
  const float high = std::nextafter(1e-30F, 1.0F);
  EXPECT_EQ(axisRelation(0, box(0, 1e-30F), box(high, 1)).type, Type::gap);
  EXPECT_EQ(axisRelation(0, box(0, high), box(1e-30F, 1)).type, Type::overlap);
  const float tiny = std::numeric_limits<float>::denorm_min();
  EXPECT_EQ(axisRelation(0, box(-1, 0), box(tiny, 1)).type, Type::gap);
}

TEST(AxisRelations, AgreeWithTheDefinitionOfOverlap) {
  std::mt19937 random(7);
  std::uniform_int_distribution<int> place(0, 5);
  int overlapping = 0;
  for (int trial = 0; trial < 5000; ++trial) {
    Aabb a;
    Aabb b;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (Aabb* aabb : {&a, &b}) {
        aabb->min[axis] = static_cast<float>(place(random)) / 3;
        aabb->max[axis] = aabb->min[axis] + static_cast<float>(place(random)) / 3;
      }
    }
    bool apart = false;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      apart = apart || axisRelation(axis, a, b).type == Type::gap;
    }
    ASSERT_EQ(!apart, overlaps(a, b));
    ASSERT_EQ(axisRelation(maxSeparationAxis(a, b), a, b).type == Type::gap, apart);
    overlapping += apart ? 0 : 1;
  }
  EXPECT_GT(overlapping, 100);
}

TEST(DecidingAxis, HasTheWidestGapOrTheLeastOverlap) {
  const Aabb a{{0, 0, 0, 0}, {4, 4, 4, 0}};
  EXPECT_EQ(maxSeparationAxis(a, {{1, 3, 2, 0}, {5, 7, 6, 0}}), 1U);
  EXPECT_EQ(maxSeparationAxis(a, {{5, 3, 7, 0}, {6, 7, 8, 0}}), 2U);
}

TEST(WrongPairs, StandByKindAndAllowedOnesLast) {
  FrameDifference difference;
  difference.allowed_extra_pairs = {{0, 1}};
  difference.false_pairs = {{0, 2}};
  difference.invalid_pairs = {{1, 1}, {0, 77}};
  difference.missed_pairs = {{1, 2}};
  std::vector<std::string> names;
  for (const WrongPair& wrong : wrongPairs(difference)) {
    names.push_back(std::string(wrong.kind->name) + " " + pairName(wrong.pair));
  }
  EXPECT_THAT(names, testing::ElementsAre("missed 1-2", "false 0-2", "invalid 1-1", "invalid 0-77",
                                          "allowed extra 0-1"));
}

TEST(PairTracks, TellSinceWhenTheyOverlap) {
  const Trail still{.body = 1, .first = 10, .boxes = std::vector<Aabb>(5, box(0, 1))};
  Trail other{.body = 2, .first = 10, .boxes = {box(0, 1), box(4, 5), box(3, 4)}};
  other.boxes.push_back(box(1, 2));
  other.boxes.push_back(box(1, 2));
  EXPECT_EQ((PairTrails{still, other, {}}.overlapStart()), 13U);
  EXPECT_FALSE(movedAt(other, 0));
  EXPECT_TRUE(movedAt(other, 3));
  EXPECT_FALSE(movedAt(other, 4));
  other.boxes.back() = box(7, 8);
  EXPECT_EQ((PairTrails{still, other, {}}.overlapStart()), std::nullopt);
  EXPECT_EQ((PairTrails{still, still, {}}.overlapStart()), 10U);
}

TEST(PairTracks, TellSinceWhenABodyIsAbsent) {
  Trail trail{.body = 1, .first = 10, .boxes = {box(0, 1), kEmptyBox, kEmptyBox}};
  EXPECT_EQ(absenceText(trail), "absent: vanished in frame 11");
  trail.boxes.front() = kEmptyBox;
  EXPECT_EQ(absenceText(trail), "absent since frame 10 or earlier");
  trail.first = 0;
  EXPECT_EQ(absenceText(trail), "absent since frame 0");
}

TEST(UnwantedPairs, TellWhy) {
  const std::vector<BodyGroups> bodies = {{.layer = 1},
                                          {.layer = 2},
                                          {.layer = 2, .world = 7},
                                          {.layer = 1, .tags = {4, 5, 6}},
                                          {.layer = 2, .tags = {6, BodyGroups::kNoTag, 9}}};
  const CollisionFilter filter(bodies, LayerMatrix().set(1, 2).set(2, 2));
  EXPECT_EQ(filterText(filter, {0, 1}), "");
  EXPECT_THAT(filterText(filter, {0, 3}), testing::HasSubstr("layer 1"));
  EXPECT_THAT(filterText(filter, {1, 2}), testing::HasSubstr("world 7"));
  EXPECT_THAT(filterText(filter, {3, 4}), testing::HasSubstr("tag"));
  EXPECT_THAT(filterText(CollisionFilter({}, LayerMatrix().set(0, 1)), {0, 1}),
              testing::HasSubstr("layer 0 does not"));
}

TEST(KnownMismatches, TheNextOfAnyLane) {
  std::vector<TrackReport> tracks(2);
  for (TrackReport& track : tracks) {
    track.spec.number = static_cast<int>(&track - tracks.data()) + 1;
    track.frames.resize(9);
  }
  EXPECT_FALSE(nextRecordedMismatch(tracks, 0));
  tracks[0].frames[7].mismatch = true;  // frame 8
  tracks[1].frames[3].mismatch = true;
  EXPECT_EQ(nextRecordedMismatch(tracks, 0)->frame, 4U);
  EXPECT_EQ(nextRecordedMismatch(tracks, 0)->track, 2);
  EXPECT_EQ(nextRecordedMismatch(tracks, 4)->frame, 8U);
  EXPECT_FALSE(nextRecordedMismatch(tracks, 8));
}

}  // namespace
}  // namespace broadmark::tests
