// The session and its run thread, without drawing.
#include "inspector/session/session.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "broadmark/algorithms.h"
#include "broadmark/files.h"
#include "broadmark/scenes/simulation.h"
#include "engine/helpers.h"
#include "inspector/helpers.h"
#include "inspector/run/frame_provider.h"
#include "inspector/run/snapshot.h"

namespace broadmark::tests {
namespace {

class SessionTest : public testing::Test {
 protected:
  SessionTest() : session(algorithmsAndFaultyOnes()) {
    setParameters(session.draft.scene(), {{"objects", "60"}, {"frames", "40"}, {"density", "0.3"}});
  }

  RunProgress waitUntilIdle() { return tests::waitUntilIdle(session); }

  /// Draws up to `most` frames, until the playback ends.
  void playOn(int most = 2000) {
    for (int picture = 0; picture < most && session.playback.playing(); ++picture) {
      session.postRequest();
      session.runs.waitUntilIdle(kForever);
      session.runs.readProgress([&](const RunProgress& progress) { session.advance(progress, 1); });
    }
  }

  Session session;
  TemporaryDirectory directory;
};

TEST_F(SessionTest, ShowsALiveSimulationAsFarAsItIsWatched) {
  session.draft.simulate();
  RunProgress seen = waitUntilIdle();
  ASSERT_TRUE(seen.snapshot);
  EXPECT_EQ(seen.snapshot->frame, 0U);
  EXPECT_EQ(seen.snapshot->boxes->size(), 60U);
  EXPECT_EQ(seen.available_frames, 0U);
  session.playback.seek(7);
  seen = waitUntilIdle();
  EXPECT_EQ(seen.snapshot->frame, 7U);
  EXPECT_EQ(seen.available_frames, 7U);
  EXPECT_THAT(seen.snapshot->pairs,
              testing::UnorderedElementsAreArray(bruteForcePairs(*seen.snapshot->boxes)));
}

TEST_F(SessionTest, EveryAlgorithmIsRightFrameByFrame) {
  session.draft.simulate();
  for (const Algorithm& algorithm : builtinAlgorithms()) {
    if (!algorithm.traits.on_device) session.tracks.add(algorithm.id);
  }
  session.playback.seek(5);
  const RunProgress seen = waitUntilIdle();
  EXPECT_EQ(seen.tracks.size(), session.tracks.list.size());
  for (const TrackReport& track : seen.tracks) {
    EXPECT_EQ(track.status, Status::ok)
        << track.spec.test_case.algorithm.id << ": " << track.reason;
    EXPECT_EQ(track.frame, 5U) << track.spec.test_case.algorithm.id;
  }
}

TEST_F(SessionTest, PlaysToTheEndAndLoops) {
  session.draft.simulate();
  waitUntilIdle();
  session.play(true);
  playOn();
  EXPECT_EQ(session.playback.frame(), 40U);
  EXPECT_FALSE(session.playback.playing());
  session.playback.loop = true;
  session.play(true);
  EXPECT_EQ(session.playback.frame(), 0U);
  playOn(100);
  EXPECT_TRUE(session.playback.playing());
}

TEST_F(SessionTest, StopsAtTheFirstMismatchAndGoesOn) {
  setParameters(session.draft.scene(), {{"objects", "200"}, {"frames", "300"}});
  session.draft.choose("brownian");
  session.draft.simulate();
  const int faulty = session.tracks.add("faulty").number;
  session.tracks.add("bf");
  session.playback.seek(300);
  const RunProgress seen = waitUntilIdle();
  ASSERT_TRUE(seen.stop) << "the fault did not show";
  EXPECT_EQ(seen.stop->track, faulty);
  EXPECT_EQ(session.playback.frame(), seen.stop->frame);
  EXPECT_EQ(seen.snapshot->frame, seen.stop->frame);
  EXPECT_EQ(seen.snapshot->track, faulty);
  ASSERT_TRUE(seen.snapshot->checked);
  EXPECT_GT(seen.snapshot->difference.missed_count, 0U);
  EXPECT_EQ(seen.tracks[1].frame, seen.stop->frame);
  EXPECT_EQ(session.notices.panels_to_raise, std::vector<std::string>{"Mismatches"});
  session.playback.step(1);
  const RunProgress later = waitUntilIdle();
  EXPECT_GT(session.playback.frame(), seen.stop->frame);
  EXPECT_EQ(later.snapshot->frame, session.playback.frame());
}

TEST_F(SessionTest, WithoutCheckingNothingStops) {
  setParameters(session.draft.scene(), {{"objects", "200"}, {"frames", "300"}});
  session.draft.choose("brownian");
  session.mismatches.check = false;
  session.draft.simulate();
  session.tracks.add("faulty");
  session.playback.seek(300);
  const RunProgress unchecked = waitUntilIdle();
  EXPECT_FALSE(unchecked.stop);
  EXPECT_EQ(session.playback.frame(), 300U);
  ASSERT_EQ(unchecked.tracks.size(), 1U);
  EXPECT_EQ(unchecked.tracks[0].frame, 300U);
  EXPECT_EQ(unchecked.tracks[0].status, Status::ok);
  EXPECT_TRUE(std::ranges::none_of(unchecked.tracks[0].frames, &FrameRecord::checked));
  // The same with the check of answers.
  session.mismatches.check = true;
  session.draft.simulate();
  session.playback.seek(300);
  const RunProgress checked = waitUntilIdle();
  ASSERT_TRUE(checked.stop) << "the fault did not show";
  EXPECT_EQ(session.playback.frame(), checked.stop->frame);
  EXPECT_LT(checked.stop->frame, 300U);
  EXPECT_EQ(checked.tracks[0].status, Status::mismatch);
}

TEST_F(SessionTest, SavedRecordingsHoldWhatWasShown) {
  session.draft.simulate();
  session.playback.seek(4);
  const RunProgress live = waitUntilIdle();
  saveRecording(session, directory / "some.aabbs");
  waitUntilIdle();
  EXPECT_TRUE(session.notices.errors.empty());
  session.open(directory / "some.aabbs");
  session.playback.seek(4);
  waitUntilIdle();  // now the length is known
  session.playback.seek(4);
  const RunProgress saved = waitUntilIdle();
  EXPECT_EQ(saved.scene.frames, 4U);
  ASSERT_EQ(saved.snapshot->frame, 4U);
  EXPECT_EQ(*saved.snapshot->boxes, *live.snapshot->boxes);
}

TEST_F(SessionTest, ABadFileIsAnErrorAndChangesNothing) {
  session.draft.simulate();
  waitUntilIdle();
  const auto before = session.playback.source();
  session.open(directory / "missing.aabbs");
  ASSERT_EQ(session.notices.errors.size(), 1U);
  EXPECT_THAT(session.notices.errors.front(), testing::HasSubstr("missing.aabbs"));
  EXPECT_EQ(session.playback.source(), before);
}

TEST_F(SessionTest, AFileOfSceneParametersBecomesTheDraft) {
  writeTextFile(directory / "scene.json", formatSceneParameters(session.draft.scene()));
  setParameters(session.draft.scene(), {{"objects", "7"}});
  session.open(directory / "scene.json");
  EXPECT_TRUE(session.notices.errors.empty());
  EXPECT_EQ(parameterValues(session.draft.scene()).at("objects"), "60");
  EXPECT_EQ(waitUntilIdle().scene.objects, 60U);
}

TEST_F(SessionTest, SettingsOfTheOriginalOpenARecordingWithALane) {
  session.draft.simulate();
  session.playback.seek(4);
  waitUntilIdle();
  saveRecording(session, directory / "some.aabbs");
  waitUntilIdle();
  writeTextFile(
      directory / "settings.json",
      R"({"m_inputScene": "some.aabbs", "m_outputLog": "log.json", "m_algorithm": "SAP"})");
  session.tracks.add("bf");
  session.open(directory / "settings.json");
  ASSERT_TRUE(session.notices.errors.empty()) << session.notices.errors.front();
  const RunProgress seen = waitUntilIdle();
  EXPECT_EQ(seen.scene.frames, 4U);
  ASSERT_EQ(seen.tracks.size(), 1U);
  EXPECT_EQ(seen.tracks[0].spec.test_case.algorithm.id, "sap");
}

TEST_F(SessionTest, OpensTheFirstEntryOfAPlan) {
  Plan plan{.algorithms = session.tracks.algorithms()};
  plan.entries = openSource("freefall", {.algorithms = plan.algorithms}).entries;
  const Algorithm& sap = *std::ranges::find(plan.algorithms, "sap", &Algorithm::id);
  plan.entries[0].cases = {Case{.algorithm = sap}};
  session.open(std::move(plan));
  session.playback.seek(2);
  const RunProgress seen = waitUntilIdle();
  EXPECT_EQ(seen.scene.name, "FreeFall");
  ASSERT_EQ(seen.tracks.size(), 1U);
  EXPECT_EQ(seen.tracks[0].frame, 2U);
}

TEST_F(SessionTest, TwoThatShareOneStateAreRightSideBySide) {
  setParameters(session.draft.scene(), {{"objects", "200"}});
  session.draft.simulate();
  for (const char* margin : {"0.01", "0.7"}) {
    setParameters(*session.tracks.add("dbvt-d").parameters, {{"margin", margin}});
  }
  session.tracks.add("dbvt-f");
  session.tracks.applyEdits();
  session.playback.seek(40);
  const RunProgress seen = waitUntilIdle();
  ASSERT_EQ(seen.tracks.size(), 3U);
  for (const TrackReport& track : seen.tracks) {
    EXPECT_EQ(track.status, Status::ok) << track.reason;
    EXPECT_EQ(track.frame, 40U);
    EXPECT_TRUE(std::ranges::all_of(track.frames, &FrameRecord::checked));
  }
  EXPECT_LT(seen.tracks[0].margin, seen.tracks[1].margin);
}

TEST_F(SessionTest, ALaneThatCannotRunTellsWhyAndLeavesTheOthersAlone) {
  Algorithm small = session.tracks.algorithms().front();
  small.traits.max_objects = 10;
  session.draft.simulate();
  session.tracks.add(Case{.algorithm = small});
  session.tracks.add("sap");
  session.playback.seek(3);
  const RunProgress seen = waitUntilIdle();
  EXPECT_EQ(seen.tracks[0].status, Status::unsupported);
  EXPECT_TRUE(seen.tracks[0].finished);
  EXPECT_THAT(seen.tracks[0].reason, testing::HasSubstr("10"));
  EXPECT_EQ(seen.tracks[1].frame, 3U);
}

TEST_F(SessionTest, EditedParametersStartTheLaneAnew) {
  session.draft.simulate();
  session.tracks.add("grid-bf");
  session.playback.seek(3);
  waitUntilIdle();
  TrackEdit& track = session.tracks.list.front();
  setParameters(*track.parameters, {{"objects_per_cell", "3"}});
  session.tracks.applyEdits();
  const RunProgress seen = waitUntilIdle();
  EXPECT_EQ(seen.tracks[0].spec.test_case.parameters.at("objects_per_cell"), "3");
  EXPECT_EQ(seen.tracks[0].frame, 3U);
}

TEST_F(SessionTest, TracksFollowBodiesBackwards) {
  session.draft.simulate();
  session.playback.seek(9);
  waitUntilIdle();
  session.selection.select({5, 2});
  const RunProgress seen = waitUntilIdle();
  ASSERT_EQ(seen.snapshot->trails.size(), 2U);
  EXPECT_EQ(seen.snapshot->trails[0].body, 2U);
  EXPECT_EQ(seen.snapshot->trails[0].boxes.size(), 10U);
  EXPECT_EQ(seen.snapshot->trails[1].boxes.back(), (*seen.snapshot->boxes)[5]);
}

TEST_F(SessionTest, TheTableOfFramesHasALinePerLaneAndFrame) {
  session.draft.simulate();
  session.tracks.add("sap");
  session.tracks.add("bf");
  session.playback.seek(3);
  const std::string table = formatFrameTable(session.playback.scene(), waitUntilIdle().tracks);
  EXPECT_EQ(std::ranges::count(table, '\n'), 1 + 2 * 3);
  EXPECT_THAT(table, testing::HasSubstr(",sap,SAP,scalar,1,,1,3,"));
  EXPECT_THAT(table,
              testing::HasSubstr(",pairs,changed_bodies,missed,false,allowed_extra,invalid,"));
}

TEST_F(SessionTest, ShowsWorldsThatChange) {
  const auto layers = [](inputs::Random&, std::uint32_t body) {
    return BodyGroups{.layer = static_cast<std::uint8_t>(body % 2)};
  };
  session.open(vanishingBodies(directory, 60, filterOf(60, LayerMatrix().set(0, 1), layers)));
  session.playback.seek(10);
  waitUntilIdle();
  session.playback.seek(10);
  RunProgress seen = waitUntilIdle();
  ASSERT_TRUE(seen.snapshot) << seen.failure;
  ASSERT_EQ(seen.snapshot->frame, 10U);
  EXPECT_EQ(seen.snapshot->present, 50U);
  EXPECT_THAT(seen.snapshot->pairs, testing::UnorderedElementsAreArray(
                                        bruteForcePairs(*seen.snapshot->boxes, seen.scene.filter)));
  EXPECT_LT(seen.snapshot->pairs.size(), bruteForcePairs(*seen.snapshot->boxes).size());
  // The population is known for the simulated frames only.
  ASSERT_EQ(seen.population.size(), 11U);
  EXPECT_TRUE(std::isnan(seen.population.at(5)));
  session.tracks.add("kd");
  session.tracks.add("sap");
  seen = waitUntilIdle();
  for (const TrackReport& track : seen.tracks) EXPECT_EQ(track.status, Status::ok) << track.reason;
  for (std::uint32_t frame = 1; frame <= 10; ++frame) {
    EXPECT_EQ(seen.population.at(frame), 60 - frame);
  }
}

TEST_F(SessionTest, WithoutChangesThereIsNoPopulation) {
  session.draft.simulate();
  session.playback.seek(3);
  EXPECT_EQ(waitUntilIdle().population.size(), 0U);
}

TEST_F(SessionTest, WishesMayChangeAtAnyTime) {
  session.draft.simulate();
  session.tracks.add("sap");
  for (int i = 0; i < 200; ++i) {
    session.playback.seek((i * 7) % 41);
    if (i % 31 == 0) session.draft.simulate();
    if (i % 17 == 0) session.tracks.add(i % 2 == 0 ? "bf" : "kd");
    if (i % 23 == 0 && !session.tracks.list.empty())
      session.tracks.remove(session.tracks.list.front().number);
    session.postRequest();
    session.runs.readProgress(
        [&](const RunProgress& progress) { session.advance(progress, 0.01); });
  }
  session.playback.seek(11);
  waitUntilIdle();
  session.playback.seek(11);
  const RunProgress seen = waitUntilIdle();
  EXPECT_EQ(seen.snapshot->frame, 11U);
  EXPECT_EQ(seen.tracks.size(), session.tracks.list.size());
}

// Forward and back, as the frames and their answers are stored.
TEST(FrameProvider, KeepsTheFiltersOfALiveSimulation) {
  const auto fountain = [] {
    auto simulation = makeSimulation("fountain");
    setParameters(*simulation, {{"objects", "60"}, {"frames", "60"}});
    return simulation;
  };
  std::vector<CollisionFilter> filters;
  const auto known = fountain();
  recordAll(*known, [&](const Frame& frame) { filters.push_back(*frame.filter); });
  ASSERT_NE(filters.back(), filters.front());
  for (const ParameterValues& reading :
       {ParameterValues(), ParameterValues{{"swept", "on"}}, ParameterValues{{"widen", "1"}}}) {
    FrameProvider provider(fountain(), reading);
    while (provider.lastAvailable() < 60) provider.simulateNext();
    const std::unique_ptr<IndexedFrames> opened = provider.opener()(60);
    for (const std::uint32_t index : {60, 3, 59, 30, 0}) {
      EXPECT_EQ(*provider.at(index).filter, filters[index]) << index;
      EXPECT_EQ(*opened->at(index).filter, filters[index]) << index;
    }
    Oracle oracle;
    const std::shared_ptr<const FrameProviderRequest> source;
    const auto snapshot = captureSnapshot(
        {.source = source, .provider = provider, .frame = 60, .trail_bodies = {}}, oracle);
    EXPECT_EQ(snapshot->scene.filter, filters[60]);
    EXPECT_EQ(snapshot->pairs, bruteForcePairs(*snapshot->boxes, filters[60]));
  }
}

// The order depends on the initial pose.
TEST(FrameProvider, ReordersALiveSimulation) {
  const auto freefall = [] {
    auto simulation = makeSimulation("freefall");
    setParameters(*simulation, {{"objects", "60"}, {"frames", "20"}});
    return simulation;
  };
  std::size_t pairs = 0;
  const auto known = freefall();
  recordAll(*known, [&](const Frame& frame) { pairs = bruteForcePairs(frame.boxes).size(); });
  FrameProvider provider(freefall(), {{"body_order", "morton"}});
  while (provider.lastAvailable() < 20) provider.simulateNext();
  EXPECT_EQ(bruteForcePairs(provider.at(20).boxes).size(), pairs);
  EXPECT_GT(pairs, 0U);
  EXPECT_EQ(provider.scene().name, "FreeFall reordered");
}

}  // namespace
}  // namespace broadmark::tests
