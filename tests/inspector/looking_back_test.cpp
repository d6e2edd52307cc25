// Frames in the answer cache are shown at once; algorithms run again only if necessary.
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

  /// The frames that the algorithm has run to.
  RunProgress simulate(const char* algorithm, std::uint32_t frame) {
    session.draft.simulate();
    session.tracks.add(algorithm);
    return seek(frame);
  }

  Session session;
};

TEST_F(LookingBackTest, NoAlgorithmRunsForAFrameThatWasSeen) {
  simulate("sap", 30);
  for (const std::uint32_t frame : {12U, 3U, 29U}) {
    const RunProgress seen = seek(frame);
    EXPECT_EQ(seen.tracks[0].frame, 30U);
    ASSERT_EQ(seen.snapshot->frame, frame);
    EXPECT_EQ(seen.snapshot->track, session.tracks.shown());
    EXPECT_TRUE(seen.snapshot->checked);
    EXPECT_EQ(seen.snapshot->oracle_pair_count, seen.snapshot->pairs.size());
    EXPECT_EQ(seen.snapshot->oracle_overlaps, seen.snapshot->overlaps);
    EXPECT_THAT(seen.snapshot->pairs,
                testing::UnorderedElementsAreArray(bruteForcePairs(*seen.snapshot->boxes)));
  }
  // The next frame continues from the algorithm's present frame.
  EXPECT_EQ(seek(31).tracks[0].frame, 31U);
}

TEST_F(LookingBackTest, FrameZeroNeedsNobody) {
  simulate("sap", 30);
  const RunProgress seen = seek(0);
  EXPECT_EQ(seen.snapshot->frame, 0U);
  EXPECT_EQ(seen.snapshot->track, 0);
  EXPECT_EQ(seen.tracks[0].frame, 30U);
}

TEST_F(LookingBackTest, AMismatchAndTheCountersComeAtOnce) {
  simulate("faulty", 300);
  const RunProgress wrong = seek(session.playback.frame());
  ASSERT_TRUE(wrong.snapshot->difference.isMismatch());
  seek(wrong.snapshot->frame - 1);
  const RunProgress again = seek(wrong.snapshot->frame);
  EXPECT_EQ(again.tracks[0].frame, wrong.snapshot->frame);
  EXPECT_EQ(again.snapshot->difference.missed_pairs, wrong.snapshot->difference.missed_pairs);
  EXPECT_EQ(again.snapshot->oracle_pair_count, wrong.snapshot->oracle_pair_count);
  EXPECT_EQ(again.snapshot->oracle_overlaps, wrong.snapshot->oracle_overlaps);
  session.tracks.clear();
  const RunProgress first = simulate("tracy", 9);
  seek(4);
  EXPECT_FALSE(first.snapshot->counters.empty());
  EXPECT_EQ(seek(9).snapshot->counters, first.snapshot->counters);
}

TEST_F(LookingBackTest, ItsStructureIsDrawnOnceItHasRunAgain) {
  simulate("grid-bf", 30);
  session.tracks.add("sap");
  seek(30);
  session.display.structure = true;
  const RunProgress seen = seek(12);
  EXPECT_EQ(seen.tracks[0].frame, 12U);
  EXPECT_EQ(seen.tracks[1].frame, 30U) << "only the shown algorithm has to";
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
  watched.tracks.add("bf");
  watched.playback.goTo(100);
  waitUntilIdle(watched);
  std::optional<RunProgress> first;
  before_step = [&] {
    if (!first) watched.runs.readProgress([&](const RunProgress& progress) { first = progress; });
  };
  watched.display.structure = true;
  watched.playback.goTo(90);
  waitUntilIdle(watched);
  ASSERT_TRUE(first);
  EXPECT_EQ(first->activity, "running bf again up to frame 90");
  EXPECT_EQ(first->snapshot->frame, 90U);
  EXPECT_FALSE(first->snapshot->pairs.empty());
  EXPECT_EQ(first->tracks[0].frame, 0U);
}

TEST_F(LookingBackTest, WhoPlaysOnHasEveryStateRight) {
  session.draft.simulate();
  for (const char* algorithm : {"tracy", "tide", "kd", "dbvt-d"}) session.tracks.add(algorithm);
  seek(40);
  EXPECT_EQ(seek(20).tracks[0].frame, 40U);
  session.play(true);
  for (int picture = 0; picture < 2000 && session.playback.frame() < 60; ++picture) {
    session.postRequest();
    session.runs.waitUntilIdle(kForever);
    session.runs.readProgress([&](const RunProgress& progress) { session.advance(progress, 1); });
  }
  const RunProgress seen = seek(session.playback.frame());
  EXPECT_GE(seen.snapshot->frame, 60U);
  for (const TrackReport& track : seen.tracks) {
    EXPECT_EQ(track.status, Status::ok) << track.reason;
    EXPECT_EQ(track.frame, seen.snapshot->frame);
    EXPECT_TRUE(std::ranges::all_of(track.frames, &FrameRecord::checked));
  }
}

TEST_F(LookingBackTest, WhatWasNotCheckedIsRunAgain) {
  session.mismatches.check = false;
  simulate("faulty", 300);
  EXPECT_EQ(seek(1).tracks[0].frame, 300U);
  session.runs.readProgress(
      [&](const RunProgress& progress) { session.mismatches.goToNext(progress); });
  const RunProgress seen = waitUntilIdle(session);
  ASSERT_TRUE(seen.stop) << "the fault did not show";
  EXPECT_EQ(seen.snapshot->frame, seen.stop->frame);
  EXPECT_TRUE(seen.snapshot->difference.isMismatch());
}

TEST_F(LookingBackTest, AnotherAlgorithmsAnswerIsItsOwn) {
  simulate("sap", 20);
  const int dbvt = session.tracks.add("dbvt-d").number;
  seek(20);
  seek(10);
  session.tracks.show(dbvt);
  const RunProgress seen = seek(10);
  EXPECT_EQ(seen.snapshot->track, dbvt);
  EXPECT_EQ(seen.tracks[1].frame, 10U) << "its answer was not kept";
  EXPECT_GT(seen.snapshot->difference.allowed_extra_count, 0U);
  EXPECT_LT(seen.snapshot->oracle_pair_count, seen.snapshot->pairs.size());
  session.tracks.show(0);
  EXPECT_EQ(seek(10).snapshot->pairs.size(), seen.snapshot->oracle_pair_count);
}

TEST_F(LookingBackTest, EditedParametersHaveSeenNothing) {
  simulate("grid-bf", 20);
  seek(10);
  setParameters(*session.tracks.list.front().parameters, {{"objects_per_cell", "3"}});
  session.tracks.applyEdits();
  EXPECT_EQ(seek(10).tracks[0].frame, 10U);
}

}  // namespace
}  // namespace broadmark::tests
