// Exporting a failing case in the background, and the cases of a results file.
#include "inspector/jobs/case_export.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadmark/algorithms.h"
#include "broadmark/files.h"
#include "broadmark/recordings/recording.h"
#include "engine/helpers.h"
#include "inspector/helpers.h"
#include "inspector/session/session.h"
#include "support/wrapped_host.h"

namespace broadmark::tests {
namespace {

using State = TaskState;

class CaseExportTest : public testing::Test {
 protected:
  CaseExportTest() : session(algorithmsAndFaultyOnes()) {}

  RunProgress waitUntilIdle() { return tests::waitUntilIdle(session); }

  /// Seeks the first mismatch of an algorithm.
  RunProgress findMismatch(const std::string& algorithm) {
    session.draft.choose("brownian");
    setParameters(session.draft.scene(), {{"engine", "kinematic"}});
    setParameters(session.draft.scene(), {{"objects", "200"}, {"frames", "60"}});
    session.draft.simulate();
    setParameters(*session.tracks.add(algorithm).parameters, {{"fat_margin", "0.5"}});
    session.tracks.applyEdits();
    session.mismatches.goToNext(waitUntilIdle());
    const RunProgress seen = waitUntilIdle();
    EXPECT_TRUE(seen.stop) << "the fault did not show";
    return seen;
  }

  CaseExport::Report waitForEnd() {
    session.jobs.get<CaseExport>().wait();
    return session.jobs.get<CaseExport>().report();
  }

  Session session;
  TemporaryDirectory directory;
};

TEST_F(CaseExportTest, WritesTheSmallestRecordingThatFails) {
  for (const std::string algorithm : {"faulty", "faulty-extra"}) {
    SCOPED_TRACE(algorithm);
    session.tracks.clear();
    const RunProgress seen = findMismatch(algorithm);
    session.exportCase(seen.tracks[0].spec.test_case, failingIn(seen), directory / algorithm);
    waitUntilIdle();
    const CaseExport::Report report = waitForEnd();
    waitUntilIdle();
    EXPECT_TRUE(session.notices.errors.empty()) << session.notices.errors.front();
    ASSERT_EQ(report.state, State::done) << report.failure;
    EXPECT_EQ(report.original_bodies, 200U);
    EXPECT_EQ(report.original_frames, seen.snapshot->frame);
    EXPECT_EQ(report.progress.bodies, algorithm == "faulty" ? 3U : 2U);
    EXPECT_LE(report.progress.frames, 2U);
    EXPECT_GT(report.progress.trials, 0U);
    EXPECT_THAT(report.command, testing::HasSubstr("--algorithm " + algorithm + " "));
    EXPECT_THAT(report.command, testing::HasSubstr("--param fat_margin=0.5"));
    EXPECT_THAT(session.notices.status.text, testing::HasSubstr("exported"));
    const auto written = openRecordingFile(directory / (algorithm + ".aabbs"));
    EXPECT_EQ(written->scene().objects, report.progress.bodies);
    EXPECT_EQ(written->scene().frames, report.progress.frames);

    session.openExport(session.jobs.get<CaseExport>().report());
    const RunProgress opened = waitUntilIdle();
    EXPECT_EQ(opened.scene.objects, report.progress.bodies);
    ASSERT_TRUE(opened.snapshot);
    EXPECT_EQ(opened.snapshot->frame, report.progress.frames);
    EXPECT_TRUE(opened.snapshot->difference.isMismatch());
    EXPECT_TRUE(session.notices.errors.empty());
  }
}

TEST_F(CaseExportTest, TheFirstWrongPairIsVisited) {
  const RunProgress seen = findMismatch("faulty");
  ASSERT_FALSE(seen.snapshot->difference.missed_pairs.empty());
  const Pair missed = seen.snapshot->difference.missed_pairs.front();
  EXPECT_THAT(session.selection.bodies(), testing::ElementsAre(missed.a, missed.b));
  EXPECT_EQ(session.selection.fly_to, session.selection.bodies());
}

TEST_F(CaseExportTest, BadFilesAreTold) {
  const RunProgress seen = findMismatch("faulty");
  session.exportCase(seen.tracks[0].spec.test_case, failingIn(seen), directory / "a.posrot");
  session.exportCase(seen.tracks[0].spec.test_case, failingIn(seen), directory / "no/a.aabbs");
  waitUntilIdle();
  ASSERT_EQ(session.notices.errors.size(), 2U);
  EXPECT_THAT(session.notices.errors[0],
              testing::AllOf(testing::HasSubstr("a.posrot"), testing::HasSubstr(".aabbs")));
  EXPECT_THAT(session.notices.errors[1], testing::HasSubstr("no/a.aabbs"));
  EXPECT_EQ(session.jobs.get<CaseExport>().report().state, State::idle);
}

TEST_F(CaseExportTest, AnotherSceneMeanwhileIsTold) {
  const RunProgress seen = findMismatch("faulty");
  session.draft.simulate();
  session.exportCase(seen.tracks[0].spec.test_case, failingIn(seen), directory / "a.aabbs");
  waitUntilIdle();
  ASSERT_EQ(session.notices.errors.size(), 1U);
  EXPECT_THAT(session.notices.errors[0], testing::HasSubstr("another scene"));
}

TEST_F(CaseExportTest, CanBeCancelled) {
  const RunProgress seen = findMismatch("faulty");
  CaseExport& work = session.jobs.get<CaseExport>();
  // The export is cancelled in the first frame of its trials, or in a later one.
  for (const int last : {1, 2, 5}) {
    int steps = 0;
    const std::function<void()> before_step = [&] {
      if (++steps == last) work.cancel();
    };
    startExport(work, seen.tracks[0].spec.test_case, seen.frames(seen.snapshot->frame),
                seen.snapshot->difference, directory / "a.aabbs",
                [&](const Case& test_case, const CancelQuery&) {
                  return std::make_unique<WatchedHost>(test_case, before_step);
                });
    EXPECT_EQ(waitForEnd().state, State::cancelled);
    EXPECT_EQ(steps, last);
    EXPECT_FALSE(std::filesystem::exists(directory / "a.aabbs"));
  }
  EXPECT_TRUE(work.consumeFinished());
  EXPECT_FALSE(work.consumeFinished());
}

TEST_F(CaseExportTest, EndsWithItsOwner) {
  const RunProgress seen = findMismatch("faulty");
  CaseExport work;
  startExport(work, seen.tracks[0].spec.test_case, seen.frames(seen.snapshot->frame),
              seen.snapshot->difference, directory / "a.aabbs");
}

TEST_F(CaseExportTest, ACaseThatDoesNotFailIsAnError) {
  const RunProgress seen = findMismatch("faulty");
  Case right = seen.tracks[0].spec.test_case;
  right.algorithm = builtinAlgorithms().front();
  right.parameters.clear();
  session.exportCase(right, failingIn(seen), directory / "a.aabbs");
  waitUntilIdle();
  EXPECT_EQ(waitForEnd().state, State::failed);
  waitUntilIdle();
  ASSERT_EQ(session.notices.errors.size(), 1U);
  EXPECT_FALSE(std::filesystem::exists(directory / "a.aabbs"));
}

TEST_F(CaseExportTest, TheSearchTellsWhenThereIsNoMismatch) {
  setParameters(session.draft.scene(), {{"objects", "50"}, {"frames", "8"}});
  session.draft.simulate();
  session.tracks.add("sap");
  session.mismatches.goToNext(waitUntilIdle());
  EXPECT_TRUE(session.mismatches.searching());
  waitUntilIdle();
  EXPECT_FALSE(session.mismatches.searching());
  EXPECT_EQ(session.playback.frame(), 8U);
  EXPECT_THAT(session.notices.status.text,
              testing::AllOf(testing::HasSubstr("mismatch"), testing::HasSubstr("8")));
}

TEST_F(CaseExportTest, TheSearchGoesOnFromMismatchToMismatch) {
  const std::uint32_t first = findMismatch("faulty-extra").stop->frame;
  RunProgress seen = waitUntilIdle();
  session.mismatches.goToNext(seen);
  seen = waitUntilIdle();
  const std::uint32_t second = seen.snapshot->frame;
  EXPECT_GT(second, first);
  EXPECT_TRUE(seen.snapshot->difference.isMismatch());
  // Known mismatches are reached without a search.
  session.playback.step(-static_cast<int>(session.playback.frame()));
  waitUntilIdle();
  session.mismatches.goToNext(waitUntilIdle());
  EXPECT_FALSE(session.mismatches.searching());
  waitUntilIdle();
  EXPECT_EQ(session.playback.frame(), first);
}

TEST_F(CaseExportTest, AResultsFileListsItsCases) {
  const RunProgress seen = findMismatch("faulty");
  ASSERT_TRUE(seen.stop);
  const std::uint32_t wrong = seen.stop->frame;
  saveRecording(session, directory / "run.aabbs");
  waitUntilIdle();
  Results results;
  CaseResult failed;
  failed.id = "some/case";
  failed.algorithm = "faulty";
  failed.family = "Faulty";
  failed.parameters = {{"fat_margin", "0.5"}};
  failed.status = Status::mismatch;
  failed.differences = {seen.snapshot->difference};
  const auto recording = openRecordingFile(directory / "run.aabbs");
  failed.recording = {.scene = recording->scene(),
                      .hash = recording->hash(),
                      .path = (directory / "run.aabbs").string()};
  CaseResult right = failed;
  right.id = "right/case";
  right.status = Status::ok;
  right.differences.clear();
  results.environments.resize(1);
  results.cases = {right, failed};
  for (const ResultWriter& writer : resultWriters()) {
    if (writer.name == "json") writeTextFile(directory / "r.json", writer.format(results));
  }
  session.open(directory / "r.json");
  ASSERT_TRUE(session.notices.errors.empty()) << session.notices.errors.front();
  ASSERT_TRUE(session.results);
  ASSERT_EQ(session.results->rows().size(), 2U);
  EXPECT_EQ(session.results->rows()[0].mismatches, 0U);
  EXPECT_EQ(session.results->rows()[1].mismatches, 1U);
  EXPECT_THAT(session.notices.panels_to_raise, testing::Contains("Cases"));

  session.openCase(directory / "r.json", "some/case");
  const RunProgress opened = waitUntilIdle();
  ASSERT_TRUE(session.notices.errors.empty()) << session.notices.errors.front();
  ASSERT_EQ(session.tracks.list.size(), 1U);
  EXPECT_EQ(opened.snapshot->frame, wrong);
  EXPECT_TRUE(opened.snapshot->difference.isMismatch());
  EXPECT_THAT(session.notices.panels_to_raise, testing::Contains("Mismatches"));

  session.openCase(directory / "r.json", "other/case");
  ASSERT_EQ(session.notices.errors.size(), 1U);
  EXPECT_THAT(session.notices.errors.front(), testing::HasSubstr("'other/case'"));
}

}  // namespace
}  // namespace broadmark::tests
