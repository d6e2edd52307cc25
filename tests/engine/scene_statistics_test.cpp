// Statistics of scenes, on small scenes with results computed by hand.

#include "broadmark/analysis/scene_statistics.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "broadmark/reference_pairs.h"
#include "engine/helpers.h"
#include "support/changing_worlds.h"

namespace broadmark::tests {
namespace {

using ::testing::DoubleEq;
using ::testing::Optional;

/// World 10 × 10 × 10 around the origin.
SceneInfo smallScene(std::uint32_t objects, std::uint32_t frames) {
  return {"Small", "Boxes", objects, frames, {{-5, -5, -5, 0}, {5, 5, 5, 0}}};
}

/// Statistics of `frame`; `before` has the boxes of the previous frame.
FrameStatistics statisticsOf(const SceneInfo& scene, const Frame& frame,
                             std::span<const Aabb> before = {}) {
  return frameStatistics(scene, frame, before, sweptPairs(frame.boxes, scene.filter).size());
}

/// Edges 1×1×1, 2×1×1 and 4×4×4; the first two touch, the third overlaps none.
std::vector<Aabb> threeBoxes() {
  return {{{0, 0, 0, 0}, {1, 1, 1, 0}},
          {{1, 0, 0, 0}, {3, 1, 1, 0}},
          {{-5, -5, -5, 0}, {-1, -1, -1, 0}}};
}

TEST(FrameStatistics, KnownAnswers) {
  const std::vector<Aabb> boxes = threeBoxes();
  const FrameStatistics figures = statisticsOf(smallScene(3, 1), {7, boxes});
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
    return statisticsOf(smallScene(3, 1), {1, boxes}, before).moving_share;
  };
  EXPECT_THAT(share(), Optional(DoubleEq(0)));
  boxes[1].max[2] = std::nextafter(boxes[1].max[2], 9.0F);
  EXPECT_THAT(share(), Optional(DoubleEq(1 / 3.0)));
  for (Aabb& box : boxes) box.min[0] -= 1;
  EXPECT_THAT(share(), Optional(DoubleEq(1)));
}

TEST(FrameStatistics, OutsideGoesByTheCentre) {
  // A box with its centre on the wall is inside; slightly further, it is outside.
  std::vector<Aabb> boxes = {{{4, 0, 0, 0}, {6, 1, 1, 0}}, {{0, -6.5F, 0, 0}, {1, -4, 1, 0}}};
  EXPECT_EQ(statisticsOf(smallScene(2, 0), {0, boxes}).outside, 1U);
  boxes[0].max[0] = 6.01F;
  EXPECT_EQ(statisticsOf(smallScene(2, 0), {0, boxes}).outside, 2U);
}

TEST(FrameStatistics, NothingAndPoints) {
  const FrameStatistics none = statisticsOf(smallScene(0, 1), {0, {}});
  EXPECT_EQ(none.density, 0);
  EXPECT_EQ(none.pairs_per_body, 0);
  EXPECT_EQ(none.max_extent, 0);
  const std::vector<Aabb> points(4);
  SceneInfo flat = smallScene(4, 1);
  flat.world = {};
  const FrameStatistics figures = statisticsOf(flat, {0, points});
  EXPECT_EQ(figures.density, 0) << "a world of no volume";
  EXPECT_EQ(figures.pairs_per_body, 1.5) << "6 pairs of 4 bodies";
  EXPECT_FALSE(rangeStatistics({&figures, 1}).sizeRatio());
}

TEST(FrameStatistics, AbsentBodiesCountNowhere) {
  const std::vector<Aabb> some = threeBoxes();
  const FrameStatistics expected = statisticsOf(smallScene(3, 1), {7, some});
  std::vector<Aabb> boxes = {kEmptyBox, some[0], some[1], kEmptyBox, some[2]};
  SceneInfo scene = smallScene(5, 1);
  scene.all_present = false;
  const FrameStatistics figures = statisticsOf(scene, {7, boxes});
  EXPECT_EQ(figures.bodies, 3U);
  EXPECT_EQ(figures.density, expected.density);
  EXPECT_EQ(figures.pairs_per_body, expected.pairs_per_body);
  EXPECT_EQ(figures.outside, 0U);
  EXPECT_EQ(figures.min_extent, 1);
  EXPECT_EQ(figures.median_extent, 2);
  EXPECT_EQ(figures.max_extent, 4);
  EXPECT_FALSE(figures.changes);

  const std::vector<Aabb> absent(5, kEmptyBox);
  const FrameStatistics none = statisticsOf(scene, {8, absent}, boxes);
  EXPECT_EQ(none.bodies, 0U);
  EXPECT_EQ(none.density, 0);
  EXPECT_EQ(none.max_extent, 0);
  EXPECT_EQ(none.changes->vanished, 3);
  EXPECT_FALSE(none.moving_share) << "no bodies";
}

TEST(FrameStatistics, WhatComesAndGoes) {
  const std::vector<Aabb> some = threeBoxes();
  // A body rests, one moves, one vanishes, two appear, one remains absent.
  const std::vector<Aabb> before = {some[0], some[1], some[2], kEmptyBox, kEmptyBox, kEmptyBox};
  const std::vector<Aabb> boxes = {some[0], some[2], kEmptyBox, some[1], some[0], kEmptyBox};
  SceneInfo scene = smallScene(6, 1);
  scene.all_present = false;
  const FrameStatistics figures = statisticsOf(scene, {1, boxes}, before);
  EXPECT_EQ(figures.bodies, 4U);
  EXPECT_EQ(figures.changes->appeared, 2);
  EXPECT_EQ(figures.changes->vanished, 1);
  EXPECT_EQ(figures.changes->changed, 4);
  EXPECT_THAT(figures.moving_share, Optional(DoubleEq(0.5)));
}

TEST(RangeStatistics, Population) {
  std::vector<FrameStatistics> frames(3);
  frames[0] = {.frame = 0, .bodies = 0};
  frames[1] = {.frame = 1, .bodies = 4, .changes = Changes{4, 0, 4}};
  frames[1].min_extent = frames[1].median_extent = frames[1].max_extent = 2;
  frames[2] = {.frame = 2, .bodies = 2, .changes = Changes{1, 3, 6}};
  frames[2].min_extent = frames[2].median_extent = frames[2].max_extent = 6;
  const RangeStatistics range = rangeStatistics(frames);
  EXPECT_EQ(range.min_bodies, 0U);
  EXPECT_DOUBLE_EQ(range.mean_bodies, 2);
  EXPECT_EQ(range.max_bodies, 4U);
  ASSERT_TRUE(range.changes);
  EXPECT_DOUBLE_EQ(range.changes->appeared, 2.5);
  EXPECT_DOUBLE_EQ(range.changes->vanished, 1.5);
  EXPECT_DOUBLE_EQ(range.changes->changed, 5);
  EXPECT_EQ(range.min_extent, 2) << "an empty frame has no sizes";
  EXPECT_EQ(range.median_extent, 4);
}

TEST(RangeStatistics, MeansMediansAndExtremes) {
  const auto statistics = [](std::uint32_t frame, double density, double pairs_per_body,
                             std::optional<double> moving_share, std::uint64_t outside,
                             std::array<double, 3> extents) {
    FrameStatistics figures{.frame = frame, .bodies = 3};
    figures.density = density;
    figures.pairs_per_body = pairs_per_body;
    figures.moving_share = moving_share;
    figures.outside = static_cast<decltype(figures.outside)>(outside);
    figures.min_extent = extents[0];
    figures.median_extent = extents[1];
    figures.max_extent = extents[2];
    return figures;
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

/// Two unit boxes that touch in the initial pose; the second moves by 1 in each frame before frame
/// `rest`.
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
  std::vector<std::uint32_t> reported;
  const auto description = describe(*source, 2, [&](std::uint32_t frame) {
    reported.push_back(frame);
    return true;
  });
  ASSERT_TRUE(description);
  EXPECT_EQ(reported, (std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5}));
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

/// Layers 1 and 3 collide with each other only, layer 4 with itself; all boxes touch. Body 4 is
/// absent in frame 2.
FrameList layeredScene() {
  SceneInfo scene = smallScene(5, 2);
  scene.all_present = false;
  const std::vector<BodyGroups> bodies = {{.layer = 1},
                                          {.layer = 3},
                                          {.layer = 3, .world = 9},
                                          {.layer = 4},
                                          {.layer = 4, .tags = {7, 8, BodyGroups::kNoTag}}};
  scene.filter = CollisionFilter(bodies, LayerMatrix().set(1, 3).set(4, 4).set(1, 5));
  const std::vector<Aabb> all(5, unitBox(0));
  std::vector<Aabb> without = all;
  without[4] = kEmptyBox;
  return listed(scene, {all, all, without});
}

TEST(Describe, LayersWorldsAndTags) {
  FrameList source = layeredScene();
  const auto description = describe(source, 1);
  ASSERT_TRUE(description->filter);
  const FilterStatistics& filter = *description->filter;
  ASSERT_EQ(filter.layers.size(), 3U);
  EXPECT_EQ(filter.layers[1].layer, 3U);
  EXPECT_EQ(filter.layers[1].bodies, 2);
  EXPECT_EQ(filter.layers[2].bodies, 1.5) << "absent in one of two frames";
  ASSERT_EQ(filter.layer_pairs.size(), 2U) << "those of layers with bodies that collide";
  EXPECT_EQ(filter.layer_pairs[0].a, 1U);
  EXPECT_EQ(filter.layer_pairs[0].b, 3U);
  EXPECT_EQ(filter.layer_pairs[0].pairs, 1) << "not across worlds";
  EXPECT_EQ(filter.layer_pairs[1].a, 4U);
  EXPECT_EQ(filter.layer_pairs[1].pairs, 0.5);
  EXPECT_EQ(filter.worlds, 2U);
  EXPECT_EQ(filter.largest_world, 4U);
  EXPECT_EQ(filter.tagged, 1U);
}

TEST(Describe, AsJson) {
  const auto source = leavingPair(2, 9);
  const DescribedRecording described = {"a \xff path", source->hash(), source->scene(),
                                        *describe(*source, 1)};
  const auto json = nlohmann::json::parse(formatDescriptions({&described, 1}));
  EXPECT_EQ(json.at("schema"), "broadmark-descriptions/1");
  const auto& recording = json.at("recordings").at(0);
  EXPECT_EQ(recording.at("hash"), source->hash());
  EXPECT_EQ(recording.at("objects"), 2);
  EXPECT_TRUE(recording.at("initial").at("moving_share").is_null());
  EXPECT_EQ(recording.at("parts").size(), 1U);
  EXPECT_EQ(recording.at("overall").at("moving_share"), 0.5);
  EXPECT_EQ(recording.at("overall").at("last_frame"), 2);
  EXPECT_EQ(recording.at("overall").at("size_ratio"), 1);
  EXPECT_FALSE(recording.at("overall").contains("bodies")) << "all bodies are present";
  EXPECT_FALSE(recording.contains("filter"));
}

TEST(Describe, ChangingWorldsAsJson) {
  FrameList source = layeredScene();
  const DescribedRecording described = {"a path", "a hash", source.scene(), *describe(source, 1)};
  const auto json = nlohmann::json::parse(formatDescriptions({&described, 1}));
  const auto& recording = json.at("recordings").at(0);
  EXPECT_TRUE(recording.at("initial").at("changed").is_null());
  const auto& overall = recording.at("overall");
  EXPECT_EQ(overall.at("bodies"), nlohmann::json::parse(R"({"min": 4, "mean": 4.5, "max": 5})"));
  EXPECT_EQ(overall.at("appeared"), 0);
  EXPECT_EQ(overall.at("vanished"), 0.5);
  EXPECT_EQ(overall.at("changed"), 0.5);
  EXPECT_EQ(recording.at("filter").at("layer_pairs").at(0),
            nlohmann::json::parse(R"({"layers": [1, 3], "pairs": 1.0})"));
  EXPECT_EQ(recording.at("filter").at("worlds"), 2);
}

}  // namespace
}  // namespace broadmark::tests
