#include "broadmark/render/overlays.h"

#include <algorithm>
#include <array>
#include <functional>
#include <span>
#include <tuple>

#include "broadmark/render/palette.h"
#include "count_steps.h"

namespace broadmark {
namespace {

constexpr float kStructureWidth = 1;
constexpr float kPopulationWidth = 2;  // wide enough for colours to be visible

std::array<float, 3> centrePoint(const Aabb& box) {
  std::array<float, 3> centre;
  // Halved first, because the sum of two large coordinates may overflow.
  for (std::size_t axis = 0; axis < 3; ++axis) {
    centre[axis] = box.min[axis] / 2 + box.max[axis] / 2;
  }
  return centre;
}

template <class Item>
void addUpTo(std::size_t limit, std::vector<Item>& items, const Item& item, Overlay& overlay) {
  if (items.size() < limit) {
    items.push_back(item);
  } else {
    ++overlay.dropped;
  }
}

Aabb boundsOf(const RecordedDrawing::Segment& line) {
  Aabb bounds;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::tie(bounds.min[axis], bounds.max[axis]) = std::minmax(line.from[axis], line.to[axis]);
  }
  return bounds;
}

Rgb colourOf(StructureRole role, const Palette& palette) {
  switch (role) {
    case StructureRole::cell:
      return palette.cell;
    case StructureRole::cell_part:
      return palette.cell_part;
    case StructureRole::split:
      return palette.split;
    case StructureRole::best_split:
      return palette.best_split;
    case StructureRole::moving_node:
      return palette.moving_node;
    case StructureRole::resting_node:
      return palette.resting_node;
  }
  return palette.cell;  // a worker process may send any value
}

/// Sorts boxes by descending population, and assigns colours to boxes with a population. Returns
/// the legend.
std::vector<LegendEntry> colourByPopulation(std::vector<RecordedDrawing::Box>& boxes,
                                            const Palette& palette, std::vector<Rgb>& colours) {
  std::ranges::stable_sort(boxes, std::ranges::greater(), &RecordedDrawing::Box::population);
  const auto count = static_cast<std::size_t>(
      std::ranges::count_if(boxes, [](const auto& box) { return box.population > 0; }));
  if (count == 0) return {};
  const CountSteps steps(boxes[count - 1].population, boxes.front().population);
  std::vector<LegendEntry> legend;
  for (std::size_t step = 0; step < steps.size(); ++step) {
    legend.push_back({steps.text(step), palette.population[steps.scaleIndex(step)]});
  }
  for (const RecordedDrawing::Box& box : std::span(boxes).first(count)) {
    LegendEntry& entry = legend[steps.stepOf(box.population)];
    colours.push_back(entry.swatch);
    ++entry.count;
  }
  return legend;
}

}  // namespace

Overlay pairLines(std::span<const Aabb> boxes, PairRuns pairs, const PairLineStyle& style,
                  std::optional<std::span<const std::uint32_t>> only) {
  std::vector<bool> is_selected(boxes.size(), !only.has_value());
  if (only) {
    for (const std::uint32_t body : *only) {
      if (body < boxes.size()) is_selected[body] = true;
    }
  }
  Overlay overlay;
  for (const PairRun pair_run : pairs) {
    for (const Pair pair : pair_run) {
      if (pair.a >= boxes.size() || pair.b >= boxes.size()) continue;
      if (!is_selected[pair.a] && !is_selected[pair.b]) continue;
      if (isEmpty(boxes[pair.a]) || isEmpty(boxes[pair.b])) continue;
      addUpTo(style.max_lines, overlay.lines,
              {centrePoint(boxes[pair.a]), centrePoint(boxes[pair.b]), style.colour, style.width,
               style.behind},
              overlay);
    }
  }
  return overlay;
}

Overlay structureOverlay(const RecordedDrawing& drawing, const StructureStyle& style) {
  const auto is_near = [&](const Aabb& box) { return !style.near || overlaps(box, *style.near); };
  std::vector<RecordedDrawing::Box> boxes;
  for (const RecordedDrawing::Box& box : drawing.boxes()) {
    if (box.level < style.first_level || box.level > style.last_level) continue;
    if (is_near(box.box)) boxes.push_back(box);
  }
  Overlay overlay;
  const Palette& palette = paletteOf(style.dark);
  std::vector<Rgb> by_population;  // the colours of the first boxes
  if (style.by_population) overlay.legend = colourByPopulation(boxes, palette, by_population);
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const bool count = i < by_population.size();
    addUpTo(style.max_items, overlay.boxes,
            {boxes[i].box, count ? by_population[i] : colourOf(boxes[i].role, palette),
             count ? kPopulationWidth : kStructureWidth},
            overlay);
  }
  if (style.by_population) std::ranges::reverse(overlay.boxes);
  for (const RecordedDrawing::Segment& line : drawing.lines()) {
    if (!is_near(boundsOf(line))) continue;
    addUpTo(style.max_items, overlay.lines,
            {line.from, line.to, colourOf(line.role, palette), kStructureWidth}, overlay);
  }
  return overlay;
}

bool hasPopulations(const RecordedDrawing& drawing) {
  return std::ranges::any_of(drawing.boxes(), [](const auto& box) { return box.population > 0; });
}

int maxLevel(const RecordedDrawing& drawing) {
  int deepest = 0;
  for (const RecordedDrawing::Box& box : drawing.boxes()) deepest = std::max(deepest, box.level);
  return deepest;
}

}  // namespace broadmark
