#include "scene_primitives.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "broadmark/range.h"
#include "broadmark/render/colour.h"

namespace broadmark {
namespace {

/// More outlines would cost time without adding information, because the tint also shows the
/// selection.
constexpr std::size_t kMaxOutlines = 2000;
constexpr float kOutlineWidth = 1.8F;
constexpr float kSelectionTint = 0.45F;

std::array<float, 4> padded(const std::array<float, 3>& point) {
  return {point[0], point[1], point[2], 0};
}

/// A box with a minimum width in pixels.
Primitive boxPrimitive(const Aabb& box, Rgb colour, const ViewSpace& space, float width) {
  return {space.toView(box.min), static_cast<float>(colour), space.toView(box.max), width};
}

std::vector<Primitive> wireframe(const Aabb& box, Rgb colour, float width, const ViewSpace& space) {
  const std::array ends = {space.toView(box.min), space.toView(box.max)};
  const auto corner = [&](std::size_t index) {
    return std::array{ends[index & 1][0], ends[(index >> 1) & 1][1], ends[(index >> 2) & 1][2]};
  };
  std::vector<Primitive> edges;
  for (std::size_t from = 0; from < 8; ++from) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t to = from | (std::size_t{1} << axis);
      if (to == from) continue;
      edges.push_back({corner(from), static_cast<float>(colour), corner(to), width});
    }
  }
  return edges;
}

/// A grid on the floor (lowest y) of a box, in squares of a tenth of its longer side.
std::vector<Primitive> floorGrid(const Aabb& box, Rgb colour, float width, const ViewSpace& space) {
  constexpr float kSquares = 10;
  const std::array low = space.toView(box.min);
  const std::array high = space.toView(box.max);
  const float step = std::max(high[0] - low[0], high[2] - low[2]) / kSquares;
  std::vector<Primitive> lines;
  if (!(step > 0)) return lines;
  for (const auto& [along, across] : {std::pair<std::size_t, std::size_t>{0, 2}, {2, 0}}) {
    const int count = static_cast<int>(std::floor((high[across] - low[across]) / step + 0.001F));
    for (int i = 1; i <= count; ++i) {
      // The line at the far wall is an edge of the world.
      const float at = low[across] + static_cast<float>(i) * step;
      if (at > high[across] - 0.001F * step) break;
      std::array<float, 3> from = low;
      from[across] = at;
      std::array<float, 3> to = from;
      to[along] = high[along];
      lines.push_back({from, static_cast<float>(colour), to, width});
    }
  }
  return lines;
}

void append(std::vector<Primitive>& lines, const std::vector<Primitive>& more) {
  lines.insert(lines.end(), more.begin(), more.end());
}

ScenePrimitives::Layer layerOf(OcclusionStyle behind) {
  switch (behind) {
    case OcclusionStyle::hidden:
      return ScenePrimitives::hidden;
    case OcclusionStyle::faint:
      return ScenePrimitives::faint;
    case OcclusionStyle::shown:
      return ScenePrimitives::shown;
  }
  return ScenePrimitives::hidden;
}

}  // namespace

void setBodies(ScenePrimitives& scene, const SceneViewContent& content, ThreadTeam& team) {
  std::vector<bool> is_selected;
  if (!content.selected.empty()) is_selected.resize(content.boxes.size());
  for (const std::uint32_t body : content.selected) {
    if (body < is_selected.size()) is_selected[body] = true;
  }
  const auto is_glass = [&](std::size_t body) {
    return !content.glass.empty() && content.glass[body] != 0;
  };
  const auto is_shown = [&](std::size_t body) {
    if (isEmpty(content.boxes[body])) return false;
    return content.visible.empty() || content.visible[body] != 0;
  };
  const auto is_visible = [&](std::size_t body) { return is_shown(body) && !is_glass(body); };
  // The visible bodies of a worker's share follow those of the previous workers.
  const std::size_t count = content.boxes.size();
  std::vector<std::size_t> begins(static_cast<std::size_t>(team.size()) + 1, 0);
  team.run(count, [&](int worker, Range share) {
    std::size_t visible = 0;
    for (std::size_t body = share.begin; body < share.end; ++body)
      visible += is_visible(body) ? 1 : 0;
    begins[static_cast<std::size_t>(worker) + 1] = visible;
  });
  std::partial_sum(begins.begin(), begins.end(), begins.begin());
  scene.boxes.resize(begins.back());
  team.run(count, [&](int worker, Range share) {
    auto box =
        scene.boxes.begin() + static_cast<std::ptrdiff_t>(begins[static_cast<std::size_t>(worker)]);
    for (std::size_t body = share.begin; body < share.end; ++body) {
      if (!is_visible(body)) continue;
      Rgb colour = content.colours[body];
      if (!is_selected.empty() && is_selected[body]) {
        colour = mixed(colour, content.theme.selected, kSelectionTint);
      }
      *box++ = boxPrimitive(content.boxes[body], colour, content.space, kBoxShading.min_pixels);
    }
  });
  scene.glass.clear();
  std::vector<Primitive>& edges = scene.lines[ScenePrimitives::glass_edges].lines;
  edges.clear();
  for (std::size_t body = 0; body < content.glass.size(); ++body) {
    if (!is_glass(body) || !is_shown(body)) continue;
    scene.glass.push_back(boxPrimitive(content.boxes[body], content.colours[body], content.space,
                                       kBoxShading.min_pixels));
    append(edges,
           wireframe(content.boxes[body], content.colours[body], content.scale, content.space));
  }
}

void setOutlines(ScenePrimitives& scene, const SceneViewContent& content) {
  std::vector<Primitive>& outlines = scene.lines[ScenePrimitives::outlines].lines;
  outlines.clear();
  for (const std::uint32_t body :
       content.selected.first(std::min(kMaxOutlines, content.selected.size()))) {
    if (body >= content.boxes.size() || isEmpty(content.boxes[body])) continue;
    append(outlines, wireframe(content.boxes[body], content.theme.selected,
                               kOutlineWidth * content.scale, content.space));
  }
}

void setLines(ScenePrimitives& scene, const SceneViewContent& content) {
  for (const OcclusionStyle behind :
       {OcclusionStyle::hidden, OcclusionStyle::faint, OcclusionStyle::shown}) {
    scene.lines[layerOf(behind)].lines.clear();
  }
  for (const SceneLine& line : content.lines) {
    scene.lines[layerOf(line.behind)].lines.push_back(
        {content.space.toView(padded(line.from)), static_cast<float>(line.colour),
         content.space.toView(padded(line.to)), line.width * content.scale});
  }
  for (const SceneWireBox& box : content.wire_boxes) {
    append(scene.lines[layerOf(box.behind)].lines,
           wireframe(box.box, box.colour, box.width * content.scale, content.space));
  }
}

void setSurroundings(ScenePrimitives& scene, const SceneViewContent& content) {
  Aabb floor = content.world;
  floor.max[1] = floor.min[1];
  scene.floor.clear();
  std::vector<Primitive>& grid = scene.lines[ScenePrimitives::grid].lines;
  grid.clear();
  if (content.shows_grid) {
    scene.floor.push_back(boxPrimitive(floor, content.theme.floor, content.space, 0));
    grid = floorGrid(content.world, content.theme.grid, content.scale, content.space);
  }
  std::vector<Primitive>& world = scene.lines[ScenePrimitives::world].lines;
  world.clear();
  if (content.shows_world) {
    world = wireframe(content.world, content.theme.world, content.scale, content.space);
  }
}

}  // namespace broadmark
