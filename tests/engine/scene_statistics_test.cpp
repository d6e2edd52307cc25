// Statistics of scenes, on scenes small enough to be worked out by hand.

#include "broadmark/scene_statistics.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "engine/helpers.h"

namespace broadmark::tests {
namespace {

using ::testing::DoubleEq;
using ::testing::Optional;

/// World 10 × 10 × 10 around the origin.
SceneInfo smallScene(std::uint32_t objects, std::uint32_t frames) {
  return {"Small", "Boxes", objects, frames, {{-5, -5, -5, 0}, {5, 5, 5, 0}}};
}

/// Edges 1×1×1, 2×1×1 and 4×4×4; the first two touch, the third is alone.
std::vector<Aabb> threeBoxes() {
  return {{{0, 0, 0, 0}, {1, 1, 1, 0}},
          {{1, 0, 0, 0}, {3, 1, 1, 0}},
          {{-5, -5, -5, 0}, {-1, -1, -1, 0}}};
}

TEST(FrameStatistics, KnownAnswers) {
  const std::vector<Aabb> boxes = threeBoxes();
  const FrameStatistics figures = frameStatistics(smallScene(3, 1), {7, boxes});
  EXPECT_EQ(figures.frame, 7U);
  EXPECT_DOUBLE_EQ(figures.density, (1 + 2 + 64) / 1000.0);
  EXPECT_DOUBLE_EQ(figures.pairs_per_body, 1 / 3.0);
  EXPECT_FALSE(figures.moving_share);
  EXPECT_EQ(figures.outside, 0U);
  EXPECT_EQ(figures.min_extent, 1);
  EXPECT_EQ(figures.median_extent, 2);
  EXPECT_EQ(figures.max_extent, 4);
}

TEST(FrameStatistics, MovingIsWhatChangedAtAll) {
  const std::vector<Aabb> before = threeBoxes();
  std::vector<Aabb> boxes = before;
  const auto share = [&] {
    return frameStatistics(smallScene(3, 1), {1, boxes}, before).moving_share;
  };
  EXPECT_THAT(share(), Optional(DoubleEq(0)));
  boxes[1].max[2] = std::nextafter(boxes[1].max[2], 9.0F);
  EXPECT_THAT(share(), Optional(DoubleEq(1 / 3.0)));
  for (Aabb& box : boxes) box.min[0] -= 1;
  EXPECT_THAT(share(), Optional(DoubleEq(1)));
}

TEST(FrameStatistics, OutsideGoesByTheCentre) {
  // Half of it out, its centre on the wall: inside. A little further: outside.
  std::vector<Aabb> boxes = {{{4, 0, 0, 0}, {6, 1, 1, 0}}, {{0, -6.5F, 0, 0}, {1, -4, 1, 0}}};
  EXPECT_EQ(frameStatistics(smallScene(2, 0), {0, boxes}).outside, 1U);
  boxes[0].max[0] = 6.01F;
  EXPECT_EQ(frameStatistics(smallScene(2, 0), {0, boxes}).outside, 2U);
}

TEST(FrameStatistics, NothingAndPoints) {
  const FrameStatistics none = frameStatistics(smallScene(0, 1), {0, {}});
  EXPECT_EQ(none.density, 0);
  EXPECT_EQ(none.pairs_per_body, 0);
  EXPECT_EQ(none.max_extent, 0);
  const std::vector<Aabb> points(4);
  SceneInfo flat = smallScene(4, 1);
  flat.world = {};
  const FrameStatistics figures = frameStatistics(flat, {0, points});
  EXPECT_EQ(figures.density, 0) << "a world of no volume";
  EXPECT_EQ(figures.pairs_per_body, 1.5) << "6 pairs of 4 bodies";
  EXPECT_FALSE(rangeStatistics({&figures, 1}).sizeRatio());
}

TEST(RangeStatistics, MeansMediansAndExtremes) {
  const auto statistics = [](std::uint32_t frame, double density, double pairs_per_body,
                             std::optional<double> moving_share, std::uint64_t outside,
                             std::array<double, 3> extents) {
    FrameStatistics one{.frame = frame, .density = density, .pairs_per_body = pairs_per_body};
    one.moving_share = moving_share;
    one.outside = static_cast<decltype(one.outside)>(outside);
    one.min_extent = extents[0];
    one.median_extent = extents[1];
    one.max_extent = extents[2];
    return one;
  };
  const std::vector<FrameStatistics> frames = {statistics(3, 0.1, 1, {}, 0, {2, 3, 4}),
                                               statistics(4, 0.2, 2, 0.5, 7, {1, 2, 8}),
                                               statistics(5, 0.6, 6, 1, 2, {2, 9, 9})};
  const RangeStatistics range = rangeStatistics(frames);
  EXPECT_EQ(range.first, 3U);
  EXPECT_EQ(range.last, 5U);
  EXPECT_DOUBLE_EQ(range.density, 0.3);
  EXPECT_DOUBLE_EQ(range.pairs_per_body, 3);
  EXPECT_THAT(range.moving_share, Optional(DoubleEq(0.75))) << "frames without one do not count";
  EXPECT_EQ(range.max_outside, 7U);
  EXPECT_EQ(range.min_extent, 1);
  EXPECT_EQ(range.median_extent, 3);
  EXPECT_EQ(range.max_extent, 9);
  EXPECT_THAT(range.sizeRatio(), Optional(DoubleEq(9)));
}

/// Two unit boxes that touch in the initial pose; in each frame the second moves on by 1, except in
/// the frames from `rest` on.
std::unique_ptr<Recording> leavingPair(std::uint32_t frames, std::uint32_t rest) {
  RecordingWriter writer(smallScene(2, frames));
  for (std::uint32_t f = 0; f <= frames; ++f) {
    const auto moves = static_cast<float>(std::min(f, rest - 1));
    writer.write(std::vector{unitBox(0), unitBox(1 + moves)});
  }
  return writer.finishTemporary();
}

TEST(Describe, PartsTheFrames) {
  const auto source = leavingPair(5, 4);
  std::vector<std::uint32_t> told;
  const auto description = describe(*source, 2, [&](std::uint32_t frame) {
    told.push_back(frame);
    return true;
  });
  ASSERT_TRUE(description);
  EXPECT_EQ(told, (std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(description->initial.last, 0U);
  EXPECT_DOUBLE_EQ(description->initial.pairs_per_body, 0.5);
  EXPECT_FALSE(description->initial.moving_share);
  ASSERT_EQ(description->parts.size(), 2U);
  EXPECT_EQ(description->parts[0].first, 1U);
  EXPECT_EQ(description->parts[0].last, 2U);
  EXPECT_THAT(description->parts[0].moving_share, Optional(DoubleEq(0.5)));
  EXPECT_EQ(description->parts[1].first, 3U);
  EXPECT_EQ(description->parts[1].last, 5U);
  EXPECT_THAT(description->parts[1].moving_share, Optional(DoubleEq(0.5 / 3)));
  EXPECT_EQ(description->overall->first, 1U);
  EXPECT_EQ(description->overall->last, 5U);
  EXPECT_THAT(description->overall->moving_share, Optional(DoubleEq(0.3)));
  EXPECT_DOUBLE_EQ(description->overall->density, 0.002);
  EXPECT_EQ(description->overall->pairs_per_body, 0);
}

TEST(Describe, FewFramesOrNone) {
  EXPECT_EQ(describe(*leavingPair(3, 9), 10)->parts.size(), 3U);
  const auto still = describe(*leavingPair(0, 9), 10);
  EXPECT_TRUE(still->parts.empty());
  EXPECT_FALSE(still->overall);
  EXPECT_DOUBLE_EQ(still->initial.pairs_per_body, 0.5);
}

TEST(Describe, CanBeStopped) {
  EXPECT_FALSE(describe(*leavingPair(5, 9), 2, [](std::uint32_t frame) { return frame < 3; }));
}

TEST(Describe, AsJson) {
  const auto source = leavingPair(2, 9);
  const DescribedRecording one = {"a \xff path", source->hash(), source->scene(),
                                  *describe(*source, 1)};
  const auto json = nlohmann::json::parse(formatDescriptions({&one, 1}));
  EXPECT_EQ(json.at("schema"), "broadmark-descriptions/1");
  const auto& recording = json.at("recordings").at(0);
  EXPECT_EQ(recording.at("hash"), source->hash());
  EXPECT_EQ(recording.at("objects"), 2);
  EXPECT_TRUE(recording.at("initial").at("moving_share").is_null());
  EXPECT_EQ(recording.at("parts").size(), 1U);
  EXPECT_EQ(recording.at("overall").at("moving_share"), 0.5);
  EXPECT_EQ(recording.at("overall").at("last_frame"), 2);
  EXPECT_EQ(recording.at("overall").at("size_ratio"), 1);
}

}  // namespace
}  // namespace broadmark::tests
