// Frames that have been seen are shown again at once; algorithms run again only where they have to.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>

#include "engine/helpers.h"
#include "inspector/helpers.h"
#include "inspector/session/session.h"
#include "support/wrapped_host.h"

namespace broadmark::tests {
namespace {

class LookingBackTest : public testing::Test {
 protected:
  LookingBackTest() : session(algorithmsAndFaultyOnes()) {
    session.draft.choose("brownian");
    setParameters(session.draft.scene(), {{"objects", "200"}, {"frames", "300"}});
  }

  RunProgress seek(std::uint32_t frame) {
    session.playback.goTo(frame);
    return tests::waitUntilIdle(session);
  }

  /// The frames that it has to have been run to.
  RunProgress simulate(const char* algorithm, std::uint32_t frame) {
    session.draft.simulate();
    session.lanes.add(algorithm);
    return seek(frame);
  }

  Session session;
};

TEST_F(LookingBackTest, NoAlgorithmRunsForAFrameThatWasSeen) {
  simulate("sap", 30);
  for (const std::uint32_t frame : {12U, 3U, 29U}) {
    const RunProgress seen = seek(frame);
    EXPECT_EQ(seen.lanes[0].frame, 30U);
    ASSERT_EQ(seen.snapshot->frame, frame);
    EXPECT_EQ(seen.snapshot->lane, session.lanes.shown());
    EXPECT_TRUE(seen.snapshot->checked);
    EXPECT_EQ(seen.snapshot->right_pairs, seen.snapshot->pairs.size());
    EXPECT_EQ(seen.snapshot->right_overlaps, seen.snapshot->overlaps);
    EXPECT_THAT(seen.snapshot->pairs,
                testing::UnorderedElementsAreArray(bruteForcePairs(*seen.snapshot->boxes)));
  }
  // What comes next is run from where it stands.
  EXPECT_EQ(seek(31).lanes[0].frame, 31U);
}

TEST_F(LookingBackTest, FrameZeroNeedsNobody) {
  simulate("sap", 30);
  const RunProgress seen = seek(0);
  EXPECT_EQ(seen.snapshot->frame, 0U);
  EXPECT_EQ(seen.snapshot->lane, 0);
  EXPECT_EQ(seen.lanes[0].frame, 30U);
}

TEST_F(LookingBackTest, AMismatchAndTheCountersComeAtOnce) {
  simulate("faulty", 300);
  const RunProgress wrong = seek(session.playback.frame());
  ASSERT_TRUE(wrong.snapshot->difference.isMismatch());
  seek(wrong.snapshot->frame - 1);
  const RunProgress again = seek(wrong.snapshot->frame);
  EXPECT_EQ(again.lanes[0].frame, wrong.snapshot->frame);
  EXPECT_EQ(again.snapshot->difference.missed_pairs, wrong.snapshot->difference.missed_pairs);
  EXPECT_EQ(again.snapshot->right_pairs, wrong.snapshot->right_pairs);
  EXPECT_EQ(again.snapshot->right_overlaps, wrong.snapshot->right_overlaps);
  session.lanes.clear();
  const RunProgress first = simulate("tracy", 9);
  seek(4);
  EXPECT_FALSE(first.snapshot->counters.empty());
  EXPECT_EQ(seek(9).snapshot->counters, first.snapshot->counters);
}

TEST_F(LookingBackTest, ItsStructureIsDrawnOnceItHasRunAgain) {
  simulate("grid-bf", 30);
  session.lanes.add("sap");
  seek(30);
  session.view.structure = true;
  const RunProgress seen = seek(12);
  EXPECT_EQ(seen.lanes[0].frame, 12U);
  EXPECT_EQ(seen.lanes[1].frame, 30U) << "only the shown algorithm has to";
  ASSERT_TRUE(seen.snapshot->structure);
  EXPECT_FALSE(seen.snapshot->structure->boxes().empty());
}

TEST_F(LookingBackTest, ThePictureComesBeforeWhatHasToRun) {
  std::function<void()> before_step = [] {};
  Session watched(algorithmsAndFaultyOnes(), [&](const Case& test_case, const CancelQuery&) {
    return std::make_unique<WatchedHost>(test_case, before_step);
  });
  watched.draft.choose("brownian");
  setParameters(watched.draft.scene(), {{"objects", "200"}, {"frames", "300"}});
  watched.draft.simulate();
  watched.lanes.add("bf");
  watched.playback.goTo(100);
  waitUntilIdle(watched);
  std::optional<RunProgress> first;
  before_step = [&] {
    if (!first) watched.runs.look([&](const RunProgress& progress) { first = progress; });
  };
  watched.view.structure = true;
  watched.playback.goTo(90);
  waitUntilIdle(watched);
  ASSERT_TRUE(first);
  EXPECT_EQ(first->doing, "running bf again up to frame 90");
  EXPECT_EQ(first->snapshot->frame, 90U);
  EXPECT_FALSE(first->snapshot->pairs.empty());
  EXPECT_EQ(first->lanes[0].frame, 0U);
}

TEST_F(LookingBackTest, WhoPlaysOnHasEveryStateRight) {
  session.draft.simulate();
  for (const char* algorithm : {"tracy", "tide", "kd", "dbvt-d"}) session.lanes.add(algorithm);
  seek(40);
  EXPECT_EQ(seek(20).lanes[0].frame, 40U);
  session.play(true);
  for (int picture = 0; picture < 2000 && session.playback.frame() < 60; ++picture) {
    session.commit();
    session.runs.waitUntilIdle(kForever);
    session.runs.look([&](const RunProgress& progress) { session.advance(progress, 1); });
  }
  const RunProgress seen = seek(session.playback.frame());
  EXPECT_GE(seen.snapshot->frame, 60U);
  for (const LaneReport& lane : seen.lanes) {
    EXPECT_EQ(lane.status, Status::ok) << lane.reason;
    EXPECT_EQ(lane.frame, seen.snapshot->frame);
    EXPECT_TRUE(std::ranges::all_of(lane.frames, &FrameRecord::checked));
  }
}

TEST_F(LookingBackTest, WhatWasNotCheckedIsRunAgain) {
  session.mismatches.check = false;
  simulate("faulty", 300);
  EXPECT_EQ(seek(1).lanes[0].frame, 300U);
  session.runs.look([&](const RunProgress& progress) { session.mismatches.goToNext(progress); });
  const RunProgress seen = waitUntilIdle(session);
  ASSERT_TRUE(seen.stop) << "the fault did not show";
  EXPECT_EQ(seen.snapshot->frame, seen.stop->frame);
  EXPECT_TRUE(seen.snapshot->difference.isMismatch());
}

TEST_F(LookingBackTest, AnotherAlgorithmsAnswerIsItsOwn) {
  simulate("sap", 20);
  const int dbvt = session.lanes.add("dbvt-d").number;
  seek(20);
  seek(10);
  session.lanes.show(dbvt);
  const RunProgress seen = seek(10);
  EXPECT_EQ(seen.snapshot->lane, dbvt);
  EXPECT_EQ(seen.lanes[1].frame, 10U) << "its answer was not kept";
  EXPECT_GT(seen.snapshot->difference.allowed_extra_count, 0U);
  EXPECT_LT(seen.snapshot->right_pairs, seen.snapshot->pairs.size());
  session.lanes.show(0);
  EXPECT_EQ(seek(10).snapshot->pairs.size(), seen.snapshot->right_pairs);
}

TEST_F(LookingBackTest, EditedParametersHaveSeenNothing) {
  simulate("grid-bf", 20);
  seek(10);
  setParameters(*session.lanes.list.front().parameters, {{"objects_per_cell", "3"}});
  session.lanes.changed();
  EXPECT_EQ(seek(10).lanes[0].frame, 10U);
}

}  // namespace
}  // namespace broadmark::tests
