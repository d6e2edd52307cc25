#include "broadmark/render/overlays.h"

#include <algorithm>
#include <tuple>

namespace broadmark {
namespace {

constexpr float kStructureWidth = 1;

std::array<float, 3> middleOf(const Aabb& box) {
  std::array<float, 3> middle;
  // Halved first: the sum of two large coordinates may overflow.
  for (std::size_t axis = 0; axis < 3; ++axis) {
    middle[axis] = box.min[axis] / 2 + box.max[axis] / 2;
  }
  return middle;
}

template <class Item>
void addUpTo(std::size_t most, std::vector<Item>& items, const Item& item, Overlay& overlay) {
  if (items.size() < most) {
    items.push_back(item);
  } else {
    ++overlay.left_out;
  }
}

Aabb boundsOf(const RecordedDrawing::Line& line) {
  Aabb bounds;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::tie(bounds.min[axis], bounds.max[axis]) = std::minmax(line.from[axis], line.to[axis]);
  }
  return bounds;
}

}  // namespace

Overlay pairLines(std::span<const Aabb> boxes, PairRuns pairs, const PairLineStyle& style,
                  std::optional<std::span<const std::uint32_t>> only) {
  std::vector<bool> is_wanted(boxes.size(), !only.has_value());
  if (only) {
    for (const std::uint32_t body : *only) {
      if (body < boxes.size()) is_wanted[body] = true;
    }
  }
  Overlay overlay;
  for (const PairRun run : pairs) {
    for (const Pair pair : run) {
      if (pair.a >= boxes.size() || pair.b >= boxes.size()) continue;
      if (!is_wanted[pair.a] && !is_wanted[pair.b]) continue;
      if (isEmpty(boxes[pair.a]) || isEmpty(boxes[pair.b])) continue;
      addUpTo(style.most, overlay.lines,
              {middleOf(boxes[pair.a]), middleOf(boxes[pair.b]), style.colour, style.width,
               style.behind},
              overlay);
    }
  }
  return overlay;
}

Overlay structureOverlay(const RecordedDrawing& drawing, const StructureFilter& filter) {
  const auto is_near = [&](const Aabb& box) { return !filter.near || overlaps(box, *filter.near); };
  Overlay overlay;
  for (const RecordedDrawing::Box& box : drawing.boxes()) {
    if (box.level < filter.first_level || box.level > filter.last_level) continue;
    if (!is_near(box.box)) continue;
    addUpTo(filter.most, overlay.boxes, {box.box, box.colour, kStructureWidth}, overlay);
  }
  for (const RecordedDrawing::Line& line : drawing.lines()) {
    if (!is_near(boundsOf(line))) continue;
    addUpTo(filter.most, overlay.lines, {line.from, line.to, line.colour, kStructureWidth},
            overlay);
  }
  return overlay;
}

int deepestLevel(const RecordedDrawing& drawing) {
  int deepest = 0;
  for (const RecordedDrawing::Box& box : drawing.boxes()) deepest = std::max(deepest, box.level);
  return deepest;
}

}  // namespace broadmark
