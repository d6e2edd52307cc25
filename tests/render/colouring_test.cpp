#include "broadmark/render/colouring.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <set>

#include "broadmark/render/colour.h"
#include "broadmark/render/overlays.h"
#include "support/colour_vision.h"

namespace broadmark::tests {
namespace {

using testing::ElementsAre;

Aabb boxOf(float low, float side) {
  return {{low, low, low, 0}, {low + side, low + side, low + side, 0}};
}

std::vector<Aabb> someBoxes(std::size_t count) {
  std::vector<Aabb> boxes;
  for (std::size_t i = 0; i < count; ++i) boxes.push_back(boxOf(static_cast<float>(i), 1));
  return boxes;
}

Colouring coloured(std::string_view id, const ColouringInput& input) {
  for (const ColourMode& mode : colourModes()) {
    if (mode.id != id) continue;
    Colouring colouring;
    mode.colour(input, colouring);
    return colouring;
  }
  ADD_FAILURE() << "no mode " << id;
  return {};
}

/// The legend's label for each body.
std::vector<std::string> labels(const Colouring& colouring) {
  std::vector<std::string> result;
  for (const Rgb colour : colouring.colours) {
    std::string label = "?";
    for (const LegendEntry& entry : colouring.legend) {
      if (entry.swatch == colour) label = entry.label;
    }
    result.push_back(label);
  }
  return result;
}

/// Relative luminance of an sRGB colour, 0 to 1.
double luminance(Rgb colour) {
  const auto linear = [](float value) {
    return value <= 0.04045F ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
  };
  const std::array rgb = components(colour);
  return 0.2126 * linear(rgb[0]) + 0.7152 * linear(rgb[1]) + 0.0722 * linear(rgb[2]);
}

TEST(Colouring, BeginsWithWhatOverlaps) {
  ASSERT_FALSE(colourModes().empty());
  EXPECT_EQ(colourModes()[0].id, "overlapping");
  const std::vector<Aabb> boxes = someBoxes(3);
  const std::vector<std::uint32_t> overlaps = {0, 2, 1};
  ColouringInput input;
  input.boxes = boxes;
  input.overlaps = overlaps;
  const Colouring colouring = coloured("overlapping", input);
  EXPECT_THAT(labels(colouring), ElementsAre("free", "overlapping", "overlapping"));
  EXPECT_EQ(colouring.legend[0].count, 2U);
  EXPECT_EQ(colouring.legend[1].count, 1U);
}

TEST(Colouring, CountsAreShownInDoublingSteps) {
  const std::vector<std::uint32_t> overlaps = {0, 1, 2, 3, 4, 7, 8, 15, 16, 31, 32, 4'000'000'000};
  const std::vector<Aabb> boxes = someBoxes(overlaps.size());
  ColouringInput input;
  input.boxes = boxes;
  input.overlaps = overlaps;
  EXPECT_THAT(labels(coloured("overlaps", input)),
              ElementsAre("0", "1", "2 to 3", "2 to 3", "4 to 7", "4 to 7", "8 to 15", "8 to 15",
                          "16 to 31", "16 to 31", "32 or more", "32 or more"));
}

TEST(Colouring, TestsAreShownInStepsOfEqualRatio) {
  const std::vector<std::uint32_t> tests = {0, 3, 5, 6, 1000, 48, 3000};
  const std::vector<Aabb> boxes = someBoxes(tests.size());
  ColouringInput input;
  input.boxes = boxes;
  EXPECT_THAT(coloured("tests", input).legend.front().label, "not reported");
  input.tests = std::span(tests).first(3);
  EXPECT_THAT(coloured("tests", input).legend.front().label, "not reported");
  input.tests = tests;
  EXPECT_THAT(
      labels(coloured("tests", input)),
      ElementsAre("0", "3 to 9", "3 to 9", "3 to 9", "949 to 3000", "30 to 94", "949 to 3000"));
  const std::vector<std::uint32_t> none(boxes.size(), 0);
  input.tests = none;
  ASSERT_EQ(coloured("tests", input).legend.size(), 1U);
  EXPECT_EQ(coloured("tests", input).legend.front().count, 7U);
}

TEST(Colouring, MissedPairsAreShownBeforeFalseOnes) {
  const std::vector<Aabb> boxes = someBoxes(6);
  const std::vector<std::uint32_t> overlaps = {0, 1, 1, 1, 1, 0};
  const std::vector<Pair> missed = {{0, 1}, {2, 77}};
  const std::vector<Pair> false_pairs = {{1, 3}, {88, 99}};
  ColouringInput input;
  input.boxes = boxes;
  input.overlaps = overlaps;
  input.missed = missed;
  input.false_pairs = false_pairs;
  EXPECT_THAT(labels(coloured("correctness", input)),
              ElementsAre("missed", "missed", "missed", "false", "correct", "free"));
}

TEST(Colouring, WhatOnlyOneOfTwoAnswersHas) {
  const std::vector<Aabb> boxes = someBoxes(7);
  const std::vector<std::uint32_t> overlaps = {1, 1, 1, 1, 1, 0, 0};
  const std::vector<Pair> first_only = {{0, 1}, {1, 77}};
  const std::vector<Pair> second_only = {{1, 2}, {5, 88}};
  const ColouringInput::Comparison comparison{first_only, second_only};
  ColouringInput input;
  input.boxes = boxes;
  input.overlaps = overlaps;
  EXPECT_EQ(coloured("comparison", input).legend.size(), 1U);
  input.comparison = &comparison;
  EXPECT_THAT(labels(coloured("comparison", input)),
              ElementsAre("first only", "first only", "second only", "both", "both", "second only",
                          "free"));
}

TEST(Colouring, MotionIsSeenAgainstThePreviousFrame) {
  const std::vector<Aabb> boxes = someBoxes(3);
  std::vector<Aabb> previous = boxes;
  previous[1].max[2] += 1e-3F;
  ColouringInput input;
  input.boxes = boxes;
  EXPECT_EQ(coloured("motion", input).legend.size(), 1U);
  input.previous = previous;
  EXPECT_THAT(labels(coloured("motion", input)), ElementsAre("static", "moving", "static"));
}

TEST(Colouring, WhatHasChangedNow) {
  const std::vector<Aabb> all = someBoxes(4);
  const std::vector<Aabb> boxes = {all[0], all[1], all[2], kEmptyBox};
  const std::vector<Aabb> previous = {all[0], all[0], kEmptyBox, all[3]};
  ColouringInput input;
  input.boxes = boxes;
  EXPECT_EQ(coloured("changes", input).legend.size(), 1U);
  input.previous = previous;
  const Colouring colouring = coloured("changes", input);
  EXPECT_EQ(labels(colouring)[0], "unchanged");
  EXPECT_EQ(labels(colouring)[1], "moved");
  EXPECT_EQ(labels(colouring)[2], "appeared");
  for (const LegendEntry& entry : colouring.legend) EXPECT_EQ(entry.count, 1U) << entry.label;
}

TEST(Colouring, LayersInUse) {
  const std::vector<Aabb> boxes = someBoxes(4);
  const std::vector<std::uint8_t> layers = {31, 2, 31, 0};
  ColouringInput input;
  input.boxes = boxes;
  EXPECT_EQ(coloured("layers", input).legend.size(), 1U);
  input.layers = layers;
  const Colouring colouring = coloured("layers", input);
  EXPECT_THAT(labels(colouring), ElementsAre("layer 31", "layer 2", "layer 31", "layer 0"));
  EXPECT_EQ(colouring.legend.size(), 3U);
}

TEST(Colouring, AbsentBodiesAreInNoClass) {
  std::vector<Aabb> boxes = someBoxes(5);
  boxes[1] = boxes[4] = kEmptyBox;
  const std::vector<Pair> pairs = {{1, 2}};
  for (const ColourMode& mode : colourModes()) {
    Colouring colouring;
    ColouringInput input;
    input.boxes = boxes;
    input.previous = boxes;
    input.missed = pairs;
    mode.colour(input, colouring);
    std::uint64_t bodies = 0;
    for (const LegendEntry& entry : colouring.legend) bodies += entry.count;
    EXPECT_EQ(bodies, 3U) << mode.id;
  }
}

TEST(Colouring, SizesAreShownInStepsOfEqualRatio) {
  const std::vector<Aabb> boxes = {boxOf(0, 0), boxOf(0, 1), boxOf(0, 9), boxOf(0, 1000),
                                   boxOf(0, 1e6F)};
  ColouringInput input;
  input.boxes = boxes;
  const Colouring colouring = coloured("size", input);
  EXPECT_THAT(labels(colouring),
              ElementsAre("1 to 10", "1 to 10", "1 to 10", "1e+03 to 1e+04", "1e+05 to 1e+06"));
}

TEST(Colouring, EveryModeColoursOddInput) {
  constexpr float kHuge = std::numeric_limits<float>::max();
  const std::vector<Aabb> odd = {{{-kHuge, -kHuge, -kHuge}, {kHuge, kHuge, kHuge}},
                                 {{0, 0, 0}, {0, 0, 0}},
                                 {{1, 1, 1}, {-1, -1, -1}}};
  const std::vector<Aabb> same = someBoxes(4);
  const std::vector<Pair> pairs = {{0, 1}, {5, 700}};
  for (const ColourMode& mode : colourModes()) {
    Colouring colouring;
    for (const std::span<const Aabb> boxes : {std::span<const Aabb>(odd), {}, {same}}) {
      ColouringInput input;
      input.boxes = boxes;
      input.missed = pairs;
      mode.colour(input, colouring);
      EXPECT_EQ(colouring.colours.size(), boxes.size()) << mode.id;
      std::uint64_t bodies = 0;
      for (const LegendEntry& entry : colouring.legend) bodies += entry.count;
      EXPECT_EQ(bodies, boxes.size() - std::ranges::count_if(boxes, isEmpty)) << mode.id;
    }
  }
}

TEST(Colouring, ModesAreNamedOnce) {
  std::set<std::string_view> ids;
  for (const ColourMode& mode : colourModes()) {
    EXPECT_TRUE(ids.insert(mode.id).second) << mode.id;
    EXPECT_FALSE(mode.title.empty());
    EXPECT_FALSE(mode.help.empty());
  }
}

TEST(Colouring, LightnessAloneTellsTheStepsOfAScaleApart) {
  std::vector<Aabb> boxes = someBoxes(7);
  for (std::size_t i = 0; i < boxes.size(); ++i) boxes[i] = boxOf(0, std::pow(2.0F, float(i)));
  const std::vector<std::uint32_t> overlaps = {0, 1, 2, 4, 8, 16, 32};
  for (const bool dark : {false, true}) {
    ColouringInput input;
    input.boxes = boxes;
    input.overlaps = overlaps;
    input.dark = dark;
    for (const char* id : {"overlaps", "size"}) {
      const Colouring colouring = coloured(id, input);
      // The first count, 0, is not on the scale.
      for (std::size_t i = id == std::string_view("overlaps") ? 2 : 1; i < colouring.legend.size();
           ++i) {
        const double before = luminance(colouring.legend[i - 1].swatch) + 0.05;
        const double step = luminance(colouring.legend[i].swatch) + 0.05;
        EXPECT_GT(dark ? step / before : before / step, 1.15) << id << " step " << i;
      }
    }
  }
}

// One man in twelve is colour-blind. Every class must be distinguishable from all others and from
// the outline of the selection.
TEST(Colouring, ClassesAreToldApartByColourBlindEyes) {
  constexpr double kLeast = 9.9;
  std::vector<Aabb> boxes = someBoxes(8);
  for (std::size_t i = 0; i < boxes.size(); ++i) boxes[i] = boxOf(0, std::pow(2.0F, float(i)));
  std::vector<Aabb> previous = boxes;
  previous[0] = kEmptyBox;
  previous[1].max[0] += 1;
  const std::vector<std::uint32_t> overlaps = {0, 1, 2, 4, 8, 16, 32, 64};
  const std::vector<std::uint32_t> tests = {0, 1, 10, 20, 40, 80, 160, 320};
  const std::vector<std::uint8_t> layers = {0, 1, 2, 3, 4, 5, 6, 7};
  const std::vector<Pair> first_only = {{1, 2}};
  const std::vector<Pair> second_only = {{3, 4}};
  const ColouringInput::Comparison comparison = {first_only, second_only};
  for (const bool dark : {false, true}) {
    const ColouringInput input{.boxes = boxes,
                               .previous = previous,
                               .overlaps = overlaps,
                               .tests = tests,
                               .layers = layers,
                               .missed = {},
                               .false_pairs = {},
                               .comparison = &comparison,
                               .dark = dark};
    for (const ColourMode& mode : colourModes()) {
      std::vector<LegendEntry> entries = coloured(mode.id, input).legend;
      EXPECT_GT(entries.size(), 1U) << mode.id;
      entries.push_back({"selected", paletteOf(dark).selected});
      for (std::size_t a = 0; a < entries.size(); ++a) {
        for (std::size_t b = 0; b < a; ++b) {
          for (const Eye& eye : kEyes) {
            EXPECT_GT(differenceOf(entries[a].swatch, entries[b].swatch, eye), kLeast)
                << mode.id << (dark ? ", dark: " : ", light: ") << entries[a].label << " and "
                << entries[b].label << ", " << eye.name;
          }
        }
      }
    }
  }
}

TEST(PairLines, GoFromMiddleToMiddle) {
  const std::vector<Aabb> boxes = {boxOf(0, 2), boxOf(10, 4), boxOf(20, 2)};
  const std::vector<Pair> pairs = {{0, 1}, {1, 2}, {0, 2}, {2, 50}};
  const PairRun list = pairs;
  PairLineStyle style;
  style.colour = 0x123456;
  const Overlay all = pairLines(boxes, {&list, 1}, style);
  ASSERT_EQ(all.lines.size(), 3U);
  EXPECT_EQ(all.lines[0].from, (std::array{1.0F, 1.0F, 1.0F}));
  EXPECT_EQ(all.lines[0].to, (std::array{12.0F, 12.0F, 12.0F}));
  EXPECT_EQ(all.lines[0].colour, 0x123456U);

  const std::vector<std::uint32_t> selection = {1, 99};
  EXPECT_EQ(pairLines(boxes, {&list, 1}, style, selection).lines.size(), 2U);
  EXPECT_EQ(pairLines(boxes, {&list, 1}, style, std::span<const std::uint32_t>()).lines.size(), 0U);
  style.max_lines = 1;
  const Overlay few = pairLines(boxes, {&list, 1}, style);
  EXPECT_EQ(few.lines.size(), 1U);
  EXPECT_EQ(few.dropped, 2U);
}

TEST(StructureOverlay, IsFilteredByLevelAndPlace) {
  RecordedDrawing drawing;
  EXPECT_EQ(maxLevel(drawing), 0);
  using enum StructureRole;
  drawing.box(boxOf(0, 100), cell, 0);
  drawing.box(boxOf(0, 10), cell_part, 1);
  drawing.box(boxOf(50, 10), moving_node, 1);
  drawing.box(boxOf(50, 5), resting_node, 2);
  drawing.line({0, 0, 0}, {5, 5, 5}, split);
  drawing.line({90, 90, 90}, {50, 50, 50}, best_split);
  EXPECT_EQ(maxLevel(drawing), 2);

  const auto shown = [&](const StructureStyle& filter) {
    std::vector<Rgb> colours;
    const Overlay overlay = structureOverlay(drawing, filter);
    for (const SceneWireBox& box : overlay.boxes) colours.push_back(box.colour);
    for (const SceneLine& line : overlay.lines) colours.push_back(line.colour);
    return colours;
  };
  const Palette& c = kLightPalette;
  EXPECT_THAT(shown({}), ElementsAre(c.cell, c.cell_part, c.moving_node, c.resting_node, c.split,
                                     c.best_split));
  StructureStyle filter;
  filter.first_level = filter.last_level = 1;
  EXPECT_THAT(shown(filter), ElementsAre(c.cell_part, c.moving_node, c.split, c.best_split));
  filter.near = boxOf(52, 1);
  EXPECT_THAT(shown(filter), ElementsAre(c.moving_node, c.best_split));
  filter = {};
  filter.max_items = 1;
  EXPECT_THAT(shown(filter), ElementsAre(c.cell, c.split));
  EXPECT_EQ(structureOverlay(drawing, filter).dropped, 4U);
}

/// A drawing with a cell of each of these populations.
RecordedDrawing cellsOf(const std::vector<std::uint32_t>& populations) {
  RecordedDrawing drawing;
  for (std::size_t i = 0; i < populations.size(); ++i) {
    drawing.cell(boxOf(static_cast<float>(i), 1), 0, populations[i]);
  }
  return drawing;
}

std::vector<std::string> texts(const std::vector<LegendEntry>& legend) {
  std::vector<std::string> all;
  for (const LegendEntry& entry : legend) {
    all.push_back(entry.label + ": " + std::to_string(entry.count));
  }
  return all;
}

TEST(StructureOverlay, ColoursCellsByPopulationTheFullestLast) {
  RecordedDrawing drawing = cellsOf({3, 1, 64, 1, 8});
  EXPECT_TRUE(hasPopulations(drawing));
  drawing.box(boxOf(0, 100), StructureRole::split, 0);
  const Overlay plain = structureOverlay(drawing, {});
  EXPECT_TRUE(plain.legend.empty());
  EXPECT_EQ(plain.boxes[0].colour, kLightPalette.cell);
  const Overlay overlay = structureOverlay(drawing, {.near = {}, .by_population = true});
  EXPECT_THAT(texts(overlay.legend), ElementsAre("1: 2", "2 to 3: 1", "4 to 7: 0", "8 to 15: 1",
                                                 "16 to 31: 0", "32 to 64: 1"));
  ASSERT_EQ(overlay.boxes.size(), 6U);
  EXPECT_EQ(overlay.boxes[0].colour, kLightPalette.split) << "it does not tell, and keeps its own";
  EXPECT_EQ(overlay.boxes[1].colour, overlay.legend[0].swatch);
  EXPECT_EQ(overlay.boxes[5].colour, overlay.legend[5].swatch);
  EXPECT_EQ(overlay.boxes[5].box, boxOf(2, 1));
  const Overlay few =
      structureOverlay(drawing, {.near = {}, .max_items = 2, .by_population = true});
  EXPECT_EQ(few.dropped, 4U);
  EXPECT_EQ(few.boxes[1].box, boxOf(2, 1));
  EXPECT_EQ(few.boxes[0].box, boxOf(4, 1));
  EXPECT_FALSE(hasPopulations(RecordedDrawing()));
  RecordedDrawing untold;
  untold.box(boxOf(0, 1), StructureRole::cell, 0);
  EXPECT_FALSE(hasPopulations(untold));
  EXPECT_TRUE(structureOverlay(untold, {.near = {}, .by_population = true}).legend.empty());
}

TEST(StructureOverlay, FewPopulationsHaveAStepEach) {
  const auto legend = [](const std::vector<std::uint32_t>& populations) {
    return texts(
        structureOverlay(cellsOf(populations), {.near = {}, .by_population = true}).legend);
  };
  EXPECT_THAT(legend({7}), ElementsAre("7: 1"));
  EXPECT_THAT(legend({1, 2, 4}), ElementsAre("1: 1", "2: 1", "3: 0", "4: 1"));
  const auto greatest = std::numeric_limits<std::uint32_t>::max();
  EXPECT_THAT(legend({greatest - 1, greatest}), testing::SizeIs(2));
  EXPECT_THAT(legend({1, greatest}), testing::SizeIs(6));
}

TEST(StructureOverlay, StepsOfPopulationAreToldApartByAllEyesAndFromTheBackground) {
  const RecordedDrawing drawing = cellsOf({1, 2, 4, 8, 16, 32});
  for (const bool dark : {false, true}) {
    const std::vector<LegendEntry> legend =
        structureOverlay(drawing, {.near = {}, .by_population = true, .dark = dark}).legend;
    ASSERT_EQ(legend.size(), 6U);
    for (std::size_t a = 0; a < legend.size(); ++a) {
      EXPECT_GT(contrastOf(legend[a].swatch, paletteOf(dark).background), 1.8);
      for (std::size_t b = 0; b < a; ++b) {
        for (const Eye& eye : kEyes) {
          EXPECT_GT(differenceOf(legend[a].swatch, legend[b].swatch, eye), 9.9)
              << legend[a].label << " and " << legend[b].label << ", " << eye.name;
        }
      }
      if (a == 0) continue;
      const double before = luminance(legend[a - 1].swatch) + 0.05;
      const double step = luminance(legend[a].swatch) + 0.05;
      EXPECT_GT(dark ? step / before : before / step, 1.15) << legend[a].label;
    }
  }
}

}  // namespace
}  // namespace broadmark::tests
