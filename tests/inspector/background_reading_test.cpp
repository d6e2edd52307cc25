// Files of other programs are read in the background.
#include "inspector/jobs/background_reading.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadmark/files.h"
#include "engine/helpers.h"
#include "inspector/helpers.h"
#include "inspector/session/session.h"

namespace broadmark::tests {
namespace {

class ReadingTest : public testing::Test {
 protected:
  ReadingTest() : session(algorithmsAndFaultyOnes()) {
    writeTextFile(csv,
                  "frame,id,min_x,min_y,min_z,max_x,max_y,max_z\n"
                  "0,0,0,0,0,1,1,1\n0,1,2,0,0,3,1,1\n0,2,4,0,0,5,1,1\n"
                  "1,0,0,0,0,1,1,1\n1,1,0,0,0,3,1,1\n1,2,4,0,0,5,1,1\n");
  }

  TemporaryDirectory directory;
  std::filesystem::path csv = directory / "boxes.csv";
  Session session;
};

TEST_F(ReadingTest, ReplacesTheSceneOnceItIsRead) {
  session.draft.simulate();
  const auto simulated = session.playback.source();
  waitUntilIdle(session);
  session.open(csv);
  EXPECT_TRUE(session.isReading());
  EXPECT_EQ(session.playback.source(), simulated);
  session.playback.seek(1);
  const RunProgress seen = waitUntilIdle(session);
  EXPECT_FALSE(session.isReading());
  EXPECT_EQ(seen.scene.objects, 3U);
  EXPECT_EQ(seen.scene.frames, 1U);
  EXPECT_TRUE(session.notices.errors.empty());
}

TEST_F(ReadingTest, AFileWithAFaultLeavesTheSceneOpen) {
  session.draft.simulate();
  const auto simulated = session.playback.source();
  waitUntilIdle(session);
  writeTextFile(csv, readTextFile(csv) + "2,0,0,0,0,1,1,one\n");
  session.open(csv);
  waitUntilIdle(session);
  EXPECT_EQ(session.playback.source(), simulated);
  EXPECT_THAT(session.notices.errors,
              testing::ElementsAre(testing::HasSubstr("boxes.csv: line 8")));
}

TEST_F(ReadingTest, GivesWayToWhatIsOpenedMeanwhile) {
  session.open(csv);
  session.draft.simulate();
  const auto simulated = session.playback.source();
  waitUntilIdle(session);
  EXPECT_FALSE(session.isReading());
  EXPECT_EQ(session.playback.source(), simulated);
  session.open(csv);
  session.open(csv);
  EXPECT_EQ(waitUntilIdle(session).scene.objects, 3U);
  EXPECT_TRUE(session.notices.errors.empty());
}

TEST_F(ReadingTest, OpensTheFileAgainWhereItIsShownTwice) {
  session.open(csv);
  waitUntilIdle(session);
  session.second = SecondViewRequest{.source = session.playback.source(), .frame = {}};
  session.playback.seek(1);
  const RunProgress seen = waitUntilIdle(session);
  EXPECT_EQ(seen.second_failure, "");
  ASSERT_NE(seen.second, nullptr);
  EXPECT_EQ(*seen.second->boxes, *seen.snapshot->boxes);
}

TEST_F(ReadingTest, CanBeCancelled) {
  // Reads for ever.
  const FileImport endless{.formats = {"csv"},
                           .extensions = {".csv"},
                           .open = [](const auto&, const ReadingOptions& options,
                                      auto&) -> std::unique_ptr<IndexedFrames> {
                             while (true) options.report(0.5);
                           }};
  BackgroundReading reading;
  startReading(reading, csv, endless);
  reading.cancel();
  reading.wait();
  EXPECT_EQ(reading.report().state, TaskState::cancelled);
  EXPECT_EQ(reading.report().source, nullptr);
}

TEST_F(ReadingTest, TextIsCancelledWithinAFrame) {
  std::string text = "frame,id,min_x,min_y,min_z,max_x,max_y,max_z\n";
  for (int body = 0; body < 10'000; ++body) {
    text += fmt::format("0,{},0,0,0,1,1,1\n", body);
  }
  writeTextFile(csv, text);
  ReadingOptions options;
  double reached = 0;
  options.progress = [&](double fraction) {
    EXPECT_GE(fraction, reached);
    reached = fraction;
    return fraction < 0.5;
  };
  const auto import = importOf(csv.string());
  ASSERT_TRUE(import);
  imports::ImportSummary summary;
  EXPECT_THROW(import->open({csv}, options, summary), Cancelled);
  EXPECT_GE(reached, 0.5);
  EXPECT_LT(reached, 1);
}

}  // namespace
}  // namespace broadmark::tests
