// Each mode assigns the bodies to a few classes with a colour and a legend entry.
#include "broadmark/render/colouring.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "broadmark/collision_filter.h"
#include "broadmark/render/palette.h"
#include "count_steps.h"

namespace broadmark {
namespace {

/// Gives each present body the colour of its class, with legend entry classOf(body), and counts the
/// bodies of each class.
template <class ClassOf>
void colourByClass(std::span<const Aabb> boxes, std::vector<LegendEntry> legend,
                   Colouring& colouring, const ClassOf& classOf) {
  colouring.colours.resize(boxes.size());
  colouring.classes.resize(boxes.size());
  colouring.legend = std::move(legend);
  for (std::size_t body = 0; body < boxes.size(); ++body) {
    if (isEmpty(boxes[body])) continue;
    const auto class_index = static_cast<std::uint8_t>(classOf(body));
    LegendEntry& entry = colouring.legend[class_index];
    colouring.classes[body] = class_index;
    ++entry.count;
    colouring.colours[body] = entry.swatch;
  }
}

std::uint32_t overlapsOf(const ColouringInput& input, std::size_t body) {
  return body < input.overlaps.size() ? input.overlaps[body] : 0;
}

/// Sets the marks of the pairs' bodies to `value`.
void mark(std::vector<std::uint8_t>& marks, std::span<const Pair> pairs, std::uint8_t value) {
  for (const Pair pair : pairs) {
    for (const std::uint32_t body : {pair.a, pair.b}) {
      if (body < marks.size()) marks[body] = value;
    }
  }
}

void colourOverlapping(const ColouringInput& input, Colouring& colouring) {
  const Palette& palette = paletteOf(input.dark);
  colourByClass(input.boxes, {{"overlapping", palette.overlapping}, {"free", palette.free}},
                colouring, [&](std::size_t body) { return overlapsOf(input, body) > 0 ? 0U : 1U; });
}

void colourByCount(const ColouringInput& input, Colouring& colouring) {
  const Palette& palette = paletteOf(input.dark);
  std::vector<LegendEntry> legend = {{"0", palette.free}, {"1", palette.heat[0]}};
  const std::size_t last = palette.heat.size() - 1;
  for (std::size_t step = 1; step < last; ++step) {
    legend.push_back({fmt::format("{} to {}", 1U << step, (2U << step) - 1), palette.heat[step]});
  }
  legend.push_back({fmt::format("{} or more", 1U << last), palette.heat[last]});
  colourByClass(input.boxes, std::move(legend), colouring, [&](std::size_t body) {
    const std::uint32_t count = overlapsOf(input, body);
    std::size_t step = count > 0 ? 1 : 0;
    for (std::size_t i = 1; i <= last; ++i) step += (count >> i) != 0 ? 1 : 0;
    return step;
  });
}

/// Colours the difference of two sets of pairs. `legend`: bodies in pairs of only the first set, of
/// only the second set, and in other pairs.
void colourByDifference(const ColouringInput& input, std::span<const Pair> first_only,
                        std::span<const Pair> second_only, std::vector<LegendEntry> legend,
                        Colouring& colouring) {
  legend.push_back({"free", paletteOf(input.dark).free});
  std::vector<std::uint8_t> classes(input.boxes.size());
  for (std::size_t body = 0; body < classes.size(); ++body) {
    classes[body] = overlapsOf(input, body) > 0 ? 2 : 3;
  }
  mark(classes, second_only, 1);
  mark(classes, first_only, 0);  // last, because a missed pair is the worse fault
  colourByClass(input.boxes, std::move(legend), colouring,
                [&](std::size_t body) { return classes[body]; });
}

void colourByCorrectness(const ColouringInput& input, Colouring& colouring) {
  const Palette& palette = paletteOf(input.dark);
  colourByDifference(
      input, input.missed, input.false_pairs,
      {{"missed", palette.missed}, {"false", palette.false_pair}, {"correct", palette.right}},
      colouring);
}

void colourUniformly(const ColouringInput& input, const std::string& label, Rgb colour,
                     Colouring& colouring) {
  colourByClass(input.boxes, {{label, colour}}, colouring, [](std::size_t) { return 0U; });
}

void colourByTests(const ColouringInput& input, Colouring& colouring) {
  const Palette& palette = paletteOf(input.dark);
  if (input.tests.size() != input.boxes.size()) {
    colourUniformly(input, "not reported", palette.unknown, colouring);
    return;
  }
  std::uint32_t min_count = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t max_count = 0;
  for (const std::uint32_t count : input.tests) {
    if (count > 0) min_count = std::min(min_count, count);
    max_count = std::max(max_count, count);
  }
  std::vector<LegendEntry> legend = {{"0", palette.free}};
  const CountSteps steps(std::min(min_count, max_count), max_count);
  for (std::size_t step = 0; step < steps.size() && max_count > 0; ++step) {
    legend.push_back({steps.text(step), palette.heat[steps.scaleIndex(step)]});
  }
  colourByClass(input.boxes, std::move(legend), colouring, [&](std::size_t body) {
    const std::uint32_t count = input.tests[body];
    return count > 0 ? steps.stepOf(count) + 1 : 0;
  });
}

void colourByComparison(const ColouringInput& input, Colouring& colouring) {
  const Palette& palette = paletteOf(input.dark);
  if (input.comparison == nullptr) {
    colourUniformly(input, "no second view", palette.unknown, colouring);
    return;
  }
  colourByDifference(input, input.comparison->first_only, input.comparison->second_only,
                     {{"first only", palette.first_only},
                      {"second only", palette.second_only},
                      {"both", palette.right}},
                     colouring);
}

void colourByMotion(const ColouringInput& input, Colouring& colouring) {
  const Palette& palette = paletteOf(input.dark);
  if (input.previous.size() != input.boxes.size()) {
    colourUniformly(input, "no previous frame", palette.unknown, colouring);
    return;
  }
  colourByClass(
      input.boxes, {{"moving", palette.moving}, {"static", palette.still}}, colouring,
      [&](std::size_t body) { return input.boxes[body] != input.previous[body] ? 0U : 1U; });
}

void colourByChange(const ColouringInput& input, Colouring& colouring) {
  const Palette& palette = paletteOf(input.dark);
  if (input.previous.size() != input.boxes.size()) {
    colourUniformly(input, "no previous frame", palette.unknown, colouring);
    return;
  }
  colourByClass(
      input.boxes,
      {{"appeared", palette.appeared}, {"moved", palette.moving}, {"unchanged", palette.still}},
      colouring, [&](std::size_t body) {
        if (isEmpty(input.previous[body])) return 0U;
        return input.boxes[body] != input.previous[body] ? 1U : 2U;
      });
}

void colourByLayer(const ColouringInput& input, Colouring& colouring) {
  const Palette& palette = paletteOf(input.dark);
  if (input.layers.size() != input.boxes.size()) {
    colourUniformly(input, "layer 0", palette.layer[0], colouring);
    return;
  }
  std::array<std::size_t, LayerMatrix::kLayers> entries{};
  for (const std::uint8_t layer : input.layers) entries[layer] = 1;
  std::vector<LegendEntry> legend;
  for (std::size_t layer = 0; layer < entries.size(); ++layer) {
    if (entries[layer] == 0) continue;
    entries[layer] = legend.size();
    legend.push_back(
        {fmt::format("layer {}", layer), palette.layer[legend.size() % palette.layer.size()]});
  }
  colourByClass(input.boxes, std::move(legend), colouring,
                [&](std::size_t body) { return entries[input.layers[body]]; });
}

void colourBySize(const ColouringInput& input, Colouring& colouring) {
  const Palette& palette = paletteOf(input.dark);
  constexpr float kMaxSize = std::numeric_limits<float>::max();
  float smallest = kMaxSize;
  float largest = 0;
  for (const Aabb& box : input.boxes) {
    const auto size = static_cast<float>(longestEdge(box));  // 0: a point, or absent
    if (size > 0) smallest = std::min(smallest, size);
    largest = std::max(largest, std::min(size, kMaxSize));
  }
  if (!(smallest < largest)) {
    colourUniformly(input, fmt::format("{:.3g}", largest), palette.size[2], colouring);
    return;
  }
  // Steps of equal ratio. Points are in the first step, like the smallest bodies.
  const std::size_t steps = palette.size.size();
  std::array<float, std::tuple_size_v<decltype(Palette::size)>> lower_bounds{};
  std::vector<LegendEntry> legend;
  const auto boundary = [&](std::size_t step) {
    const double fraction = static_cast<double>(step) / static_cast<double>(steps);
    return smallest * std::pow(double{largest} / double{smallest}, fraction);
  };
  for (std::size_t step = 0; step < steps; ++step) {
    lower_bounds[step] = static_cast<float>(boundary(step));
    legend.push_back(
        {fmt::format("{:.3g} to {:.3g}", boundary(step), boundary(step + 1)), palette.size[step]});
  }
  colourByClass(input.boxes, std::move(legend), colouring, [&](std::size_t body) {
    const auto size = static_cast<float>(longestEdge(input.boxes[body]));
    std::size_t step = 0;
    for (std::size_t i = 1; i < steps; ++i) step += size >= lower_bounds[i] ? 1 : 0;
    return step;
  });
}

constexpr ColourMode kModes[] = {
    {"overlapping", "Overlapping", "bodies that overlap another", colourOverlapping, true},
    {"overlaps", "Number of overlaps", "number of pairs of each body", colourByCount, true},
    {.id = "tests",
     .title = "Tests of boxes",
     .help = "number of box tests with each body, if the shown algorithm reports them",
     .colour = colourByTests,
     .of_tests = true},
    {"correctness", "Missed and false", "bodies of missed pairs and of false pairs",
     colourByCorrectness},
    {"motion", "Moving and static", "bodies whose box has changed since the previous frame",
     colourByMotion},
    {"changes", "Appeared or moved", "bodies that appeared or moved since the previous frame",
     colourByChange},
    {"layers", "Layer", "the layer of each body; beyond eight the colours repeat", colourByLayer},
    {"size", "Size", "longest edge of each body, in steps of equal ratio", colourBySize},
    {"comparison", "First and second view",
     "bodies of pairs that only one of two views shows, the first view's before the second's",
     colourByComparison},
};

}  // namespace

std::span<const ColourMode> colourModes() { return kModes; }

std::size_t colourModeIndex(std::string_view id) {
  return static_cast<std::size_t>(std::ranges::find(kModes, id, &ColourMode::id) -
                                  std::begin(kModes));
}

}  // namespace broadmark
