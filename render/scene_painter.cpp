// The order of drawing: boxes first; floor and grid wherever there is no box; then lines, tested
// against the depths of the boxes. Where the processor drew the boxes it hands over their depths.
#include "scene_painter.h"

#include <algorithm>
#include <numeric>

#include "axes_cross.h"
#include "broadmark/range.h"
#include "colour.h"

namespace broadmark {
namespace {

/// More outlines cost time and tell the eye nothing; the tint still shows what is selected.
constexpr std::size_t kMostOutlines = 2000;
constexpr float kOutlineWidth = 1.8F;
constexpr float kSelectionTint = 0.45F;
constexpr float kFaint = 0.28F;

void setClearColour(const Gl& gl, Rgb colour) {
  const std::array rgb = components(colour);
  gl.ClearColor(rgb[0], rgb[1], rgb[2], 1);
}

Aabb boundsOf(std::span<const Primitive> boxes, Aabb bounds) {
  for (const Primitive& box : boxes) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      bounds.min[axis] = std::min(bounds.min[axis], box.from[axis]);
      bounds.max[axis] = std::max(bounds.max[axis], box.to[axis]);
    }
  }
  return bounds;
}

std::array<float, 4> padded(const std::array<float, 3>& point) {
  return {point[0], point[1], point[2], 0};
}

}  // namespace

ScenePainter::ScenePainter(const Gl& gl, const SceneViewOptions& options)
    : gl_(&gl),
      team_(std::max(1, options.threads)),
      box_renderer_(gl, options.max_batch),
      line_renderer_(gl) {
  const bool splats = options.technique == Technique::splat ||
                      (options.technique == Technique::automatic && isSoftwareRenderer(gl));
  if (splats) splatter_ = std::make_unique<BoxSplatter>(team_, options.isa);
}

bool ScenePainter::update(const SceneViewContent& content) {
  const Drawn wanted{content.bodies_revision, content.lines_revision, content.space,
                     content.world,           content.theme,          content.shows_world,
                     content.shows_grid,      content.shows_axes,     content.scale};
  if (drawn_ == wanted) return false;
  const bool all = !drawn_ || drawn_->space != wanted.space;
  const bool bodies = all || drawn_->bodies_revision != wanted.bodies_revision ||
                      drawn_->theme != wanted.theme || drawn_->scale != wanted.scale;
  const bool lines =
      all || drawn_->lines_revision != wanted.lines_revision || drawn_->scale != wanted.scale;
  if (bodies) {
    updateBodies(content);
    updateOutlines(content);
  }
  if (lines) updateLines(content);
  updateSurroundings(content);
  drawn_ = wanted;
  return true;
}

void ScenePainter::updateBodies(const SceneViewContent& content) {
  std::vector<bool> is_selected;
  if (!content.selected.empty()) is_selected.resize(content.boxes.size());
  for (const std::uint32_t body : content.selected) {
    if (body < is_selected.size()) is_selected[body] = true;
  }
  const auto is_visible = [&](std::size_t body) {
    if (isEmpty(content.boxes[body])) return false;
    return content.visible.empty() || content.visible[body] != 0;
  };
  // The visible bodies of a worker's share follow those of the workers before it.
  const std::size_t count = content.boxes.size();
  std::vector<std::size_t> begins(static_cast<std::size_t>(team_.size()) + 1, 0);
  team_.run([&](int worker) {
    const auto [begin, end] = share(count, team_.size(), worker);
    std::size_t visible = 0;
    for (std::size_t body = begin; body < end; ++body) visible += is_visible(body) ? 1 : 0;
    begins[static_cast<std::size_t>(worker) + 1] = visible;
  });
  std::partial_sum(begins.begin(), begins.end(), begins.begin());
  boxes_.resize(begins.back());
  team_.run([&](int worker) {
    const auto [begin, end] = share(count, team_.size(), worker);
    auto box =
        boxes_.begin() + static_cast<std::ptrdiff_t>(begins[static_cast<std::size_t>(worker)]);
    for (std::size_t body = begin; body < end; ++body) {
      if (!is_visible(body)) continue;
      Rgb colour = content.colours[body];
      if (!is_selected.empty() && is_selected[body]) {
        colour = mixed(colour, content.theme.selection, kSelectionTint);
      }
      *box++ = boxPrimitive(content.boxes[body], colour, content.space);
    }
  });
  if (!splatter_) box_buffer_ = box_renderer_.upload(boxes_);
}

void ScenePainter::updateOutlines(const SceneViewContent& content) {
  std::vector<Primitive> edges;
  for (const std::uint32_t body :
       content.selected.first(std::min(kMostOutlines, content.selected.size()))) {
    if (body >= content.boxes.size() || isEmpty(content.boxes[body])) continue;
    const std::vector<Primitive> box = wireframe(content.boxes[body], content.theme.selection,
                                                 kOutlineWidth * content.scale, content.space);
    edges.insert(edges.end(), box.begin(), box.end());
  }
  outlines_.lines = line_renderer_.upload(edges);
}

void ScenePainter::updateLines(const SceneViewContent& content) {
  for (LineLayer& layer : lines_) {
    std::vector<Primitive> lines;
    for (const SceneLine& line : content.lines) {
      if (line.behind != layer.behind) continue;
      lines.push_back({content.space.toView(padded(line.from)), static_cast<float>(line.colour),
                       content.space.toView(padded(line.to)), line.width * content.scale});
    }
    for (const SceneWireBox& box : content.wire_boxes) {
      if (box.behind != layer.behind) continue;
      const std::vector<Primitive> edges =
          wireframe(box.box, box.colour, box.width * content.scale, content.space);
      lines.insert(lines.end(), edges.begin(), edges.end());
    }
    layer.lines = line_renderer_.upload(lines);
  }
}

void ScenePainter::updateSurroundings(const SceneViewContent& content) {
  bounds_ = boundsOf(boxes_, content.space.toView(content.world));
  // The floor is drawn behind everything that rests on it or sinks through it.
  Aabb floor = content.world;
  floor.max[1] = floor.min[1];
  std::vector<Primitive> floors;
  if (content.shows_grid) {
    floors.push_back(boxPrimitive(floor, content.theme.floor, content.space, 0));
  }
  floor_ = box_renderer_.upload(floors);
  std::vector<Primitive> grid;
  if (content.shows_grid) {
    grid = floorGrid(content.world, content.theme.grid, content.scale, content.space);
  }
  grid_ = line_renderer_.upload(grid);
  std::vector<Primitive> world;
  if (content.shows_world) {
    world = wireframe(content.world, content.theme.world, content.scale, content.space);
  }
  world_.lines = line_renderer_.upload(world);
}

void ScenePainter::draw(const Viewpoint& viewpoint, const Framebuffer& target) {
  gl_->Enable(GL_DEPTH_TEST);
  gl_->DepthFunc(GL_LEQUAL);
  gl_->DepthMask(GL_TRUE);
  gl_->Disable(GL_BLEND);
  gl_->Disable(GL_SCISSOR_TEST);
  gl_->Disable(GL_CULL_FACE);
  drawBoxes(viewpoint, target);

  gl_->DepthMask(GL_FALSE);
  gl_->ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_FALSE);  // the picture stays opaque
  gl_->BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  drawFloor(viewpoint);
  gl_->Enable(GL_BLEND);
  drawLines(world_, viewpoint);
  for (const LineLayer& layer : lines_) drawLines(layer, viewpoint);
  drawLines(outlines_, viewpoint);
  gl_->Disable(GL_DEPTH_TEST);
  if (drawn_->shows_axes) drawAxes(viewpoint);
  gl_->DepthMask(GL_TRUE);
  gl_->ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  gl_->Disable(GL_BLEND);
}

void ScenePainter::drawBoxes(const Viewpoint& viewpoint, const Framebuffer& target) {
  if (splatter_) {
    splatter_->draw(boxes_, viewpoint);
    target.write(splatter_->colours(), splatter_->depths());
    target.bind();
    return;
  }
  target.bind();
  setClearColour(*gl_, viewpoint.haze);
  gl_->Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  box_renderer_.draw(box_buffer_, viewpoint);
}

void ScenePainter::drawFloor(const Viewpoint& viewpoint) const {
  // At the far end of the depth range: everything drawn so far is in front of it.
  gl_->DepthRange(1, 1);
  box_renderer_.draw(floor_, viewpoint);
  gl_->Enable(GL_BLEND);
  line_renderer_.draw(grid_, viewpoint);
  gl_->DepthRange(0, 1);
}

void ScenePainter::drawLines(const LineLayer& layer, const Viewpoint& viewpoint) const {
  if (layer.behind != Behind::hidden) {
    gl_->DepthFunc(GL_GREATER);
    line_renderer_.draw(layer.lines, viewpoint, layer.behind == Behind::faint ? kFaint : 1);
    gl_->DepthFunc(GL_LEQUAL);
  }
  line_renderer_.draw(layer.lines, viewpoint);
}

void ScenePainter::drawAxes(const Viewpoint& viewpoint) const {
  const float scale = drawn_->scale;
  const Viewpoint corner = axesViewpoint(viewpoint, scale);
  const auto margin = static_cast<int>(kAxesMargin * scale);
  gl_->Viewport(margin, margin, corner.width, corner.height);
  line_renderer_.draw(line_renderer_.upload(axesCross(viewpoint.camera, scale)), corner);
}

}  // namespace broadmark
