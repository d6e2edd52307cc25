// The section of the recording that the timeline shows.
#include "inspector/session/timeline.h"

#include <gtest/gtest.h>

namespace broadmark::tests {
namespace {

class TimelineTest : public testing::Test {
 protected:
  TimelineTest() { timeline.update(source, 1000, 0); }

  void playTo(std::uint32_t frame) { timeline.update(source, 1000, frame); }
  [[nodiscard]] bool isInSight(double frame) const {
    return frame >= timeline.first() && frame <= timeline.last();
  }

  Timeline timeline;
  std::shared_ptr<const FrameProviderRequest> source = std::make_shared<FrameProviderRequest>();
};

TEST_F(TimelineTest, ShowsTheWholeRecordingAtFirst) {
  EXPECT_EQ(timeline.first(), 0);
  EXPECT_EQ(timeline.last(), 1000);
  EXPECT_FALSE(timeline.zoomed());
}

TEST_F(TimelineTest, ZoomsAboutAFrameAndStaysWithinTheRecording) {
  timeline.zoom(3, 250);
  EXPECT_TRUE(timeline.zoomed());
  const double share = (250 - timeline.first()) / (timeline.last() - timeline.first());
  EXPECT_NEAR(share, 0.25, 1e-9);
  timeline.scroll(1e6);
  EXPECT_EQ(timeline.last(), 1000);
  timeline.scroll(-1e6);
  EXPECT_EQ(timeline.first(), 0);
  timeline.zoom(1000, 0);
  EXPECT_GE(timeline.last() - timeline.first(), 1);
  timeline.zoom(-1000, 0);
  EXPECT_FALSE(timeline.zoomed());
}

TEST_F(TimelineTest, FollowsThePlayhead) {
  timeline.zoom(10, 0);
  const double extent = timeline.last() - timeline.first();
  for (const std::uint32_t frame : {400U, 401U, 1000U, 3U, 0U, 999U}) {
    playTo(frame);
    EXPECT_TRUE(isInSight(frame)) << frame;
    EXPECT_NEAR(timeline.last() - timeline.first(), extent, 1e-9);
  }
  // A section chosen by the user stays until the playhead moves.
  timeline.scroll(-500);
  playTo(999);
  EXPECT_FALSE(isInSight(999));
  playTo(1000);
  EXPECT_TRUE(isInSight(1000));
}

TEST_F(TimelineTest, SpansLieWithinTheTimedFrames) {
  EXPECT_FALSE(timeline.span());
  timeline.select(20.4, 9.6);
  EXPECT_EQ(timeline.span(), (FrameSpan{10, 20}));
  timeline.select(-3, 2000);
  EXPECT_EQ(timeline.span(), (FrameSpan{1, 1000}));
  timeline.select(100, 300);
  timeline.showSpan();
  EXPECT_NEAR(timeline.first(), 100, 1e-9);
  EXPECT_NEAR(timeline.last(), 300, 1e-9);
  timeline.clearSpan();
  EXPECT_FALSE(timeline.span());
}

TEST_F(TimelineTest, ZoomAndSpanBelongToTheFootage) {
  timeline.zoom(10, 500);
  timeline.select(400, 600);
  timeline.update(std::make_shared<FrameProviderRequest>(), 60, 0);
  EXPECT_FALSE(timeline.zoomed());
  EXPECT_EQ(timeline.last(), 60);
  EXPECT_FALSE(timeline.span());
  timeline.update(source, 1000, 7);
  EXPECT_FALSE(timeline.zoomed());
  EXPECT_EQ(timeline.last(), 1000);
}

}  // namespace
}  // namespace broadmark::tests
