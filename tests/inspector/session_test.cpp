// The session and its run thread, without any drawing.
#include "inspector/session.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadmark/algorithms.h"
#include "engine/helpers.h"
#include "inspector/helpers.h"

namespace broadmark::tests {
namespace {

using namespace std::chrono_literals;

class SessionTest : public testing::Test {
 protected:
  SessionTest() : session(algorithmsAndFaultyOnes()) {
    setParameters(*session.draft, {{"objects", "60"}, {"frames", "40"}, {"density", "0.3"}});
  }

  RunProgress settle() { return settled(session); }

  /// Lets pictures pass until the playback ends, or `most` have.
  void playOn(int most = 2000) {
    for (int picture = 0; picture < most && session.playback.playing; ++picture) {
      session.commit();
      session.runs.settle(60s);
      session.runs.look([&](const RunProgress& progress) { session.advance(progress, 1); });
    }
  }

  Session session;
  TemporaryDirectory directory;
};

TEST_F(SessionTest, ShowsALiveSimulationAsFarAsItIsWatched) {
  session.simulate();
  RunProgress seen = settle();
  ASSERT_TRUE(seen.snapshot);
  EXPECT_EQ(seen.snapshot->frame, 0U);
  EXPECT_EQ(seen.snapshot->boxes->size(), 60U);
  EXPECT_EQ(seen.known_frames, 0U);
  session.seek(7);
  seen = settle();
  EXPECT_EQ(seen.snapshot->frame, 7U);
  EXPECT_EQ(seen.known_frames, 7U);
  EXPECT_THAT(seen.snapshot->pairs,
              testing::UnorderedElementsAreArray(bruteForcePairs(*seen.snapshot->boxes)));
}

TEST_F(SessionTest, SeekingBackReplaysTheHistory) {
  session.simulate();
  const int lane = session.addLane("sap").number;
  session.seek(12);
  settle();
  session.seek(3);
  const RunProgress seen = settle();
  ASSERT_EQ(seen.lanes.size(), 1U);
  EXPECT_EQ(seen.lanes[0].frame, 3U);
  EXPECT_EQ(seen.snapshot->lane, lane);
  EXPECT_EQ(seen.lanes[0].status, Status::ok) << seen.lanes[0].reason;
  EXPECT_THAT(seen.snapshot->pairs,
              testing::UnorderedElementsAreArray(bruteForcePairs(*seen.snapshot->boxes)));
  // What was measured of later frames is still there to be plotted.
  EXPECT_NE(seen.lanes[0].record(12), nullptr);
}

TEST_F(SessionTest, EveryAlgorithmIsRightFrameByFrame) {
  session.simulate();
  for (const Algorithm& algorithm : builtinAlgorithms()) {
    if (!algorithm.on_device) session.addLane(algorithm.id);
  }
  session.seek(5);
  const RunProgress seen = settle();
  for (const LaneReport& lane : seen.lanes) {
    const bool excluded = lane.status == Status::unsupported;  // two that share one state
    EXPECT_TRUE(lane.status == Status::ok || excluded)
        << lane.spec.run.algorithm.id << ": " << lane.reason;
    EXPECT_TRUE(excluded || lane.frame == 5U) << lane.spec.run.algorithm.id;
  }
}

TEST_F(SessionTest, PlaysToTheEndAndLoops) {
  session.simulate();
  settle();
  session.play(true);
  playOn();
  EXPECT_EQ(session.frame(), 40U);
  EXPECT_FALSE(session.playback.playing);
  session.playback.loop = true;
  session.play(true);
  EXPECT_EQ(session.frame(), 0U);
  playOn(100);
  EXPECT_TRUE(session.playback.playing);
}

TEST_F(SessionTest, StopsAtTheFirstMismatchAndGoesOn) {
  setParameters(*session.draft, {{"objects", "200"}, {"frames", "300"}});
  session.chooseScene("brownian");
  session.simulate();
  const int faulty = session.addLane("faulty").number;
  session.addLane("bf");
  session.seek(300);
  const RunProgress seen = settle();
  ASSERT_TRUE(seen.stop) << "the fault did not show";
  EXPECT_EQ(seen.stop->lane, faulty);
  EXPECT_EQ(session.frame(), seen.stop->frame);
  EXPECT_EQ(seen.snapshot->frame, seen.stop->frame);
  EXPECT_EQ(seen.snapshot->lane, faulty);
  ASSERT_TRUE(seen.snapshot->checked);
  EXPECT_GT(seen.snapshot->difference.missed_count, 0U);
  EXPECT_EQ(seen.lanes[1].frame, seen.stop->frame);
  EXPECT_EQ(session.wanted_panels, std::vector<std::string>{"Mismatches"});
  session.step(1);
  const RunProgress later = settle();
  EXPECT_GT(session.frame(), seen.stop->frame);
  EXPECT_EQ(later.snapshot->frame, session.frame());
}

TEST_F(SessionTest, WithoutCheckingNothingStops) {
  setParameters(*session.draft, {{"objects", "200"}, {"frames", "60"}});
  session.wish.check = false;
  session.simulate();
  session.addLane("none");
  session.seek(60);
  const RunProgress seen = settle();
  EXPECT_FALSE(seen.stop);
  EXPECT_EQ(session.frame(), 60U);
}

TEST_F(SessionTest, SavedRecordingsHoldWhatWasShown) {
  session.simulate();
  session.seek(4);
  const RunProgress live = settle();
  session.saveRecording(directory / "some.aabbs");
  settle();
  EXPECT_TRUE(session.errors.empty());
  session.open(directory / "some.aabbs");
  session.seek(4);
  settle();  // now its length is known
  session.seek(4);
  const RunProgress saved = settle();
  EXPECT_EQ(saved.scene.frames, 4U);
  ASSERT_EQ(saved.snapshot->frame, 4U);
  EXPECT_EQ(*saved.snapshot->boxes, *live.snapshot->boxes);
}

TEST_F(SessionTest, ABadFileIsAnErrorAndChangesNothing) {
  session.simulate();
  settle();
  const auto before = session.wish.footage;
  session.open(directory / "missing.aabbs");
  ASSERT_EQ(session.errors.size(), 1U);
  EXPECT_THAT(session.errors.front(), testing::HasSubstr("missing.aabbs"));
  EXPECT_EQ(session.wish.footage, before);
}

TEST_F(SessionTest, TwoThatShareOneStateDoNotRunSideBySide) {
  session.simulate();
  session.addLane("dbvt-d");
  session.addLane("dbvt-f");
  session.seek(2);
  const RunProgress seen = settle();
  EXPECT_EQ(seen.lanes[0].status, Status::ok);
  EXPECT_EQ(seen.lanes[1].status, Status::unsupported);
}

TEST_F(SessionTest, EditedParametersStartTheLaneAnew) {
  session.simulate();
  session.addLane("grid-bf");
  session.seek(3);
  settle();
  LaneEdit& lane = session.lanes.front();
  setParameters(*lane.parameters, {{"objects_per_cell", "3"}});
  session.lanesChanged();
  const RunProgress seen = settle();
  EXPECT_EQ(seen.lanes[0].spec.run.parameters.at("objects_per_cell"), "3");
  EXPECT_EQ(seen.lanes[0].frame, 3U);
}

TEST_F(SessionTest, TracksFollowBodiesBackwards) {
  session.simulate();
  session.seek(9);
  settle();
  session.select({5, 2});
  const RunProgress seen = settle();
  ASSERT_EQ(seen.snapshot->tracks.size(), 2U);
  EXPECT_EQ(seen.snapshot->tracks[0].body, 2U);
  EXPECT_EQ(seen.snapshot->tracks[0].boxes.size(), 10U);
  EXPECT_EQ(seen.snapshot->tracks[1].boxes.back(), (*seen.snapshot->boxes)[5]);
}

TEST_F(SessionTest, TheTableOfFramesHasALinePerLaneAndFrame) {
  session.simulate();
  session.addLane("sap");
  session.addLane("bf");
  session.seek(3);
  const std::string table = formatFrameTable(settle());
  EXPECT_EQ(std::ranges::count(table, '\n'), 1 + 2 * 3);
  EXPECT_THAT(table, testing::HasSubstr("sap,scalar,1,3,"));
}

TEST_F(SessionTest, WishesMayChangeAtAnyTime) {
  session.simulate();
  session.addLane("sap");
  for (int i = 0; i < 200; ++i) {
    session.seek((i * 7) % 41);
    if (i % 31 == 0) session.simulate();
    if (i % 17 == 0) session.addLane(i % 2 == 0 ? "bf" : "kd");
    if (i % 23 == 0 && !session.lanes.empty()) session.removeLane(session.lanes.front().number);
    session.commit();
    session.runs.look([&](const RunProgress& progress) { session.advance(progress, 0.01); });
  }
  session.seek(11);
  settle();
  session.seek(11);
  const RunProgress seen = settle();
  EXPECT_EQ(seen.snapshot->frame, 11U);
  EXPECT_EQ(seen.lanes.size(), session.lanes.size());
}

}  // namespace
}  // namespace broadmark::tests
