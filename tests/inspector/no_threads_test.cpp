// The inspector where the system grants no threads, as browsers do to pages that are not isolated:
// all work happens between pictures.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pthread.h>

#include <thread>

#include "broadmark/recordings/recording.h"
#include "engine/helpers.h"
#include "inspector/helpers.h"

namespace broadmark::tests {
namespace {

/// Refuses threads: none gets a stack of this size.
class NoThreads {
 public:
  NoThreads() {
    pthread_getattr_default_np(&former_);
    pthread_attr_t huge;
    pthread_attr_init(&huge);
    pthread_attr_setstacksize(&huge, std::size_t{1} << 46);
    pthread_setattr_default_np(&huge);
    pthread_attr_destroy(&huge);
  }
  ~NoThreads() {
    pthread_setattr_default_np(&former_);
    pthread_attr_destroy(&former_);
  }
  NoThreads(const NoThreads&) = delete;
  NoThreads& operator=(const NoThreads&) = delete;

 private:
  pthread_attr_t former_;
};

class NoThreadsTest : public testing::Test {
 protected:
  NoThreads no_threads;
  TemporaryDirectory directory;
  Session session{algorithmsAndFaultyOnes()};
};

TEST_F(NoThreadsTest, NoneIsGranted) {
  EXPECT_THROW(std::thread([] {}), std::system_error);
}

TEST_F(NoThreadsTest, ASceneRunsAndAWrongAnswerStopsIt) {
  setParameters(session.draft.scene(), {{"objects", "200"}, {"frames", "60"}});
  session.draft.choose("brownian");
  session.draft.simulate();
  session.tracks.add("columns").test_case.threads = 1;
  setParameters(*session.tracks.add("faulty").parameters, {{"fat_margin", "0.5"}});
  session.tracks.applyEdits();
  session.playback.seek(60);
  const RunProgress seen = waitUntilIdle(session);
  ASSERT_TRUE(seen.stop) << "the fault did not show";
  EXPECT_EQ(seen.snapshot->frame, seen.stop->frame);
  EXPECT_EQ(seen.tracks[0].status, Status::ok);
  EXPECT_EQ(seen.tracks[1].status, Status::mismatch);
}

TEST_F(NoThreadsTest, AStepAPictureIsEnough) {
  setParameters(session.draft.scene(), {{"objects", "30"}, {"frames", "10"}});
  session.draft.simulate();
  session.playback.seek(10);
  int pictures = 0;
  for (session.postRequest(); !session.runs.isIdle() && pictures < 100; ++pictures) {
    session.runs.proceed(std::chrono::milliseconds(0));
  }
  EXPECT_GE(pictures, 10);
  EXPECT_TRUE(session.runs.isIdle());
}

TEST_F(NoThreadsTest, JobsHaveEndedOnceTheyAreStarted) {
  setParameters(session.draft.scene(), {{"objects", "30"}, {"frames", "10"}});
  session.draft.simulate();
  for (const char* algorithm : {"bf", "sap"}) session.tracks.add(algorithm).test_case.threads = 1;
  session.tracks.applyEdits();
  session.playback.seek(10);
  waitUntilIdle(session);
  session.saveRecording(directory / "saved.aabbs");
  EXPECT_EQ(session.jobs.get<BackgroundSave>().report().state, TaskState::done);
  EXPECT_EQ(openRecordingFile(directory / "saved.aabbs")->scene().frames, 10U);

  BackgroundBake& bake = session.jobs.get<BackgroundBake>();
  BakeOptions options;
  options.sources = {"freefall"};
  options.scene = {.objects = {20, 30},
                   .object_types = {"cubes"},
                   .parameters = {{"frames", "5"}},
                   .recorders = {"aabbs"}};
  options.record = directory / "baked";
  options.threads = 2;
  startBake(bake, options);
  EXPECT_EQ(bake.report().state, TaskState::done) << bake.report().failure;
  EXPECT_EQ(bake.report().count(BakeOutcome::baked), 2U);

  session.startDuel(0.1);
  EXPECT_EQ(session.jobs.get<BackgroundDuel>().report().state, TaskState::done);
  EXPECT_TRUE(session.notices.errors.empty()) << session.notices.errors.front();
}

}  // namespace
}  // namespace broadmark::tests
