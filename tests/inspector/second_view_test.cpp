// Two views side by side, and the comparison of their answers.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "inspector/helpers.h"
#include "inspector/run/run_thread.h"
#include "inspector/session/track_statistics.h"

namespace broadmark::tests {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(ComparePairs, TellsWhoHasWhat) {
  const std::vector<Pair> first = {{4, 5}, {1, 2}, {0, 3}, {1, 2}};
  const std::vector<Pair> second = {{1, 2}, {4, 6}, {4, 5}, {2, 3}};
  const PairComparison comparison = comparePairs(first, second);
  EXPECT_THAT(comparison.first_only, ElementsAre(Pair{0, 3}));
  EXPECT_THAT(comparison.second_only, ElementsAre(Pair{2, 3}, Pair{4, 6}));
  EXPECT_EQ(comparison.both, 2U);
  EXPECT_EQ(comparePairs(first, {}).both, 0U);
}

TrackReport trackOf(const std::vector<std::int64_t>& nanoseconds) {
  TrackReport track;
  for (const std::int64_t ns : nanoseconds) {
    FrameRecord& record = track.frames.emplace_back();
    record.run = ns > 0;
    record.times[Phase::total] = ns;
  }
  return track;
}

TEST(TimeRatios, AreOfFramesThatBothHaveRunUndisturbed) {
  TrackReport first = trackOf({10, 30, 0, 40, 99, 7});
  const TrackReport second = trackOf({20, 10, 50, 40, 1});
  first.frames[4].disturbed = true;
  const TimeRatios ratios = ratiosOf(first, second);
  EXPECT_FLOAT_EQ(ratios.ratios.at(1), 0.5F);
  EXPECT_FLOAT_EQ(ratios.ratios.at(2), 3);
  EXPECT_TRUE(std::isnan(ratios.ratios.at(3)));
  EXPECT_TRUE(std::isnan(ratios.ratios.at(5)));
  EXPECT_EQ(ratios.first_slower, 1U);
  EXPECT_EQ(ratios.second_slower, 1U);
  EXPECT_DOUBLE_EQ(ratios.median, 1);
  EXPECT_EQ(ratios.highest->frame, 2U);
  EXPECT_EQ(ratios.lowest->frame, 1U);
  EXPECT_FALSE(ratiosOf(first, trackOf({})).highest);
}

class SecondViewTest : public testing::Test {
 protected:
  SecondViewTest() : session(algorithmsAndFaultyOnes()) {
    setParameters(session.draft.scene(),
                  {{"objects", "60"}, {"frames", "20"}, {"engine", "kinematic"}});
    session.draft.simulate();
    faulty = session.tracks.add("faulty-extra").number;
    sap = session.tracks.add("sap").number;
    session.tracks.show(faulty);
    session.mismatches.stop_at_mismatch = false;
    session.playback.goTo(12);
    waitUntilIdle(session);
  }

  std::vector<Pair> rightPairs(const Snapshot& snapshot) {
    return sweptPairs(*snapshot.boxes, snapshot.scene.filter);
  }

  TemporaryDirectory directory;
  Session session;
  int faulty = 0;
  int sap = 0;
};

TEST_F(SecondViewTest, AnotherAlgorithmInTheSameFrame) {
  EXPECT_EQ(waitUntilIdle(session).second, nullptr);
  session.showSecond(true);
  const RunProgress seen = waitUntilIdle(session);
  ASSERT_TRUE(seen.second);
  EXPECT_EQ(seen.second->track, sap);
  EXPECT_EQ(seen.snapshot->track, faulty);
  EXPECT_EQ(seen.second->frame, 12U);
  EXPECT_EQ(*seen.second->boxes, *seen.snapshot->boxes);
  ASSERT_TRUE(seen.comparison);
  EXPECT_EQ(seen.comparison->both, seen.second->pairs.size());
  EXPECT_THAT(seen.comparison->second_only, IsEmpty());
  EXPECT_EQ(seen.comparison->first_only.size(),
            seen.snapshot->pairs.size() - seen.second->pairs.size());

  // The second view follows the first.
  session.playback.goTo(15);
  EXPECT_EQ(waitUntilIdle(session).second->frame, 15U);
  session.tracks.remove(sap);
  EXPECT_EQ(waitUntilIdle(session).second->track, 0);
  session.showSecond(false);
  const RunProgress alone = waitUntilIdle(session);
  EXPECT_EQ(alone.second, nullptr);
  EXPECT_EQ(alone.comparison, nullptr);
}

TEST_F(SecondViewTest, AnotherFrameOfTheSameRecording) {
  session.second = SecondViewRequest{.source = nullptr, .frame = 5, .track = sap};
  RunProgress seen = waitUntilIdle(session);
  ASSERT_TRUE(seen.second);
  EXPECT_EQ(seen.second->frame, 5U);
  EXPECT_EQ(seen.second->track, sap);
  EXPECT_TRUE(seen.second->checked);
  EXPECT_FALSE(seen.second->difference.isMismatch());
  EXPECT_EQ(seen.second->oracle_pair_count, rightPairs(*seen.second).size());
  EXPECT_EQ(seen.snapshot->frame, 12U);
  EXPECT_NE(*seen.second->boxes, *seen.snapshot->boxes);
  // The tracks have not been rerun.
  for (const TrackReport& track : seen.tracks) EXPECT_EQ(track.frame, 12U);

  // A frame after the first view's: the scene is simulated up to it.
  session.second->frame = 18;
  seen = waitUntilIdle(session);
  EXPECT_EQ(seen.second->frame, 18U);
  EXPECT_EQ(seen.second->track, sap);
  EXPECT_EQ(seen.snapshot->frame, 12U);
  // Earlier frames need a new instance; also the first view's frame, and frames past the end.
  for (const std::uint32_t frame : {3U, 12U, 0U, 99U}) {
    session.second->frame = frame;
    seen = waitUntilIdle(session);
    EXPECT_EQ(seen.second->frame, std::min(frame, 20U));
    EXPECT_EQ(seen.second->pairs.size(), rightPairs(*seen.second).size());
  }
}

TEST_F(SecondViewTest, AnotherRecording) {
  const std::filesystem::path other = vanishingBodies(directory, 40);
  session.tracks.show(sap);  // sap supports vanishing bodies
  session.openInSecondView(other);
  RunProgress seen = waitUntilIdle(session);
  ASSERT_TRUE(session.notices.errors.empty()) << session.notices.errors.front();
  ASSERT_TRUE(seen.second);
  EXPECT_EQ(seen.second->source->title, other.filename());
  EXPECT_EQ(seen.second->frame, 12U);
  EXPECT_EQ(seen.second->present, 28U);
  EXPECT_EQ(seen.second->track, sap);
  EXPECT_EQ(seen.snapshot->source, session.playback.source());

  // The second view remains when the first opens another source.
  session.draft.simulate();
  session.playback.goTo(2);
  seen = waitUntilIdle(session);
  ASSERT_TRUE(seen.second);
  EXPECT_EQ(seen.second->frame, 2U);
  EXPECT_EQ(seen.second->present, 38U);
}

TEST_F(SecondViewTest, WhatCannotBeOpenedSaysWhy) {
  session.openInSecondView("none.aabbs");
  ASSERT_EQ(session.notices.errors.size(), 1U);
  EXPECT_FALSE(session.second);

  // The file is removed before it is opened.
  const std::filesystem::path other = vanishingBodies(directory, 40);
  session.openInSecondView(other);
  std::filesystem::remove(other);
  const RunProgress seen = waitUntilIdle(session);
  EXPECT_EQ(seen.second, nullptr);
  EXPECT_THAT(seen.second_failure, HasSubstr("vanishing.broadmark"));
  EXPECT_TRUE(seen.snapshot);
  EXPECT_EQ(seen.failure, "");
}

}  // namespace
}  // namespace broadmark::tests
