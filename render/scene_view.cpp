// The order of drawing: boxes first; floor and grid wherever there is no box; then lines, tested
// against the boxes' depths, which the processor hands over where it has drawn them.
#include "broadmark/render/scene_view.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string_view>

#include "colour.h"

namespace broadmark {
namespace {

/// More outlines than that are no help to the eye, only costly; the tint still shows what is
/// selected.
constexpr std::size_t kMostOutlines = 2000;
constexpr float kOutlineWidth = 1.8F;
constexpr float kSelectionTint = 0.45F;
constexpr float kFaint = 0.28F;

// The cross of axes, in pixels.
constexpr float kAxesSide = 96;
constexpr float kAxesMargin = 8;
constexpr float kAxesWidth = 2.4F;
constexpr float kAxesReach = 1.55F;  ///< half the side in lengths of an axis
constexpr float kAxesLabels = 1.28F;
constexpr float kAxesDistance = 8;

void setClearColour(const Gl& gl, Rgb colour) {
  const std::array rgb = components(colour);
  gl.ClearColor(rgb[0], rgb[1], rgb[2], 1);
}

/// Puts back the framebuffer and viewport that were set.
class TargetGuard {
 public:
  explicit TargetGuard(const Gl& gl) : gl_(&gl), framebuffer_(gl.integer(GL_FRAMEBUFFER_BINDING)) {
    gl.GetIntegerv(GL_VIEWPORT, viewport_);
  }
  ~TargetGuard() {
    gl_->BindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(framebuffer_));
    gl_->Viewport(viewport_[0], viewport_[1], viewport_[2], viewport_[3]);
  }
  TargetGuard(const TargetGuard&) = delete;
  TargetGuard& operator=(const TargetGuard&) = delete;

 private:
  const Gl* gl_;
  GLint framebuffer_;
  GLint viewport_[4]{};
};

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

/// Sees the unit cross from where the picture's camera sees the scene.
Viewpoint axesViewpoint(const Viewpoint& viewpoint, float scale) {
  const CameraAxes axes = axesOf(viewpoint.camera);
  Viewpoint result = viewpoint;
  result.width = result.height = std::max(1, static_cast<int>(std::lround(kAxesSide * scale)));
  constexpr float kHalf = kAxesReach / kAxesDistance;
  result.camera = {};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    result.camera.eye[axis] = kAxesDistance * axes.back[axis];
  }
  result.camera.window_min = {-kHalf, -kHalf};
  result.camera.window_max = {kHalf, kHalf};
  return result;
}

}  // namespace

bool isSoftwareRenderer(const Gl& gl) {
  const auto* text = reinterpret_cast<const char*>(gl.GetString(GL_RENDERER));
  const std::string_view name = text != nullptr ? text : "";
  const auto is_in_name = [&](const char* part) {
    return name.find(part) != std::string_view::npos;
  };
  return is_in_name("llvmpipe") || is_in_name("softpipe") || is_in_name("SWR") ||
         is_in_name("Software") || is_in_name("SwiftShader");
}

SceneView::SceneView(const Gl& gl, const SceneViewOptions& options)
    : gl_(&gl),
      is_software_(isSoftwareRenderer(gl)),
      samples_(options.samples),
      team_(std::max(1, options.threads)),
      box_renderer_(gl, options.max_batch),
      line_renderer_(gl) {
  const bool splats = options.technique == Technique::splat ||
                      (options.technique == Technique::automatic && is_software_);
  if (splats) splatter_ = std::make_unique<BoxSplatter>(team_, options.isa);
  if (splats) samples_ = 1;
  if (samples_ == 0) samples_ = is_software_ ? 1 : Framebuffer::kSamples;
  resize(1, 1);
}

SceneView::~SceneView() = default;

void SceneView::resize(int width, int height) {
  width = std::max(width, 1);
  height = std::max(height, 1);
  if (framebuffer_ && framebuffer_->width() == width && framebuffer_->height() == height) return;
  const TargetGuard guard(*gl_);
  is_up_to_date_ = false;
  framebuffer_.reset();  // before the new one: both may not fit
  framebuffer_ = std::make_unique<Framebuffer>(*gl_, width, height, samples_);
}

void SceneView::draw(const SceneViewContent& content, const OrbitCamera& camera) {
  update(content);
  const double aspect = static_cast<double>(framebuffer_->width()) / framebuffer_->height();
  draw(content, toCamera(camera, aspect, contents_));
}

void SceneView::draw(const SceneViewContent& content, const Camera& camera) {
  update(content);
  const Viewpoint viewpoint{camera, framebuffer_->width(), framebuffer_->height(),
                            content.theme.background};
  if (is_up_to_date_ && viewpoint == viewpoint_) return;
  viewpoint_ = viewpoint;
  const TargetGuard guard(*gl_);
  drawPicture(viewpoint);
  framebuffer_->resolve();
  is_up_to_date_ = true;
}

Picture SceneView::read() const {
  const TargetGuard guard(*gl_);
  return framebuffer_->read();
}

void SceneView::update(const SceneViewContent& content) {
  const Drawn wanted{content.bodies_revision, content.lines_revision, content.space,
                     content.world,           content.theme,          content.shows_world,
                     content.shows_grid,      content.shows_axes,     content.scale};
  if (drawn_ == wanted) return;
  is_up_to_date_ = false;
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
}

void SceneView::updateBodies(const SceneViewContent& content) {
  std::vector<bool> is_selected;
  if (!content.selected.empty()) is_selected.resize(content.boxes.size());
  for (const std::uint32_t body : content.selected) {
    if (body < is_selected.size()) is_selected[body] = true;
  }
  const auto is_visible = [&](std::size_t body) {
    return content.visible.empty() || content.visible[body] != 0;
  };
  // Each worker's share begins behind the visible bodies of those before it.
  const std::size_t count = content.boxes.size();
  std::vector<std::size_t> begins(static_cast<std::size_t>(team_.size()) + 1, 0);
  team_.run([&](int worker) {
    const auto [first, last] = share(count, team_.size(), worker);
    std::size_t visible = 0;
    for (std::size_t body = first; body < last; ++body) visible += is_visible(body) ? 1 : 0;
    begins[static_cast<std::size_t>(worker) + 1] = visible;
  });
  std::partial_sum(begins.begin(), begins.end(), begins.begin());
  boxes_.resize(begins.back());
  team_.run([&](int worker) {
    const auto [first, last] = share(count, team_.size(), worker);
    auto box =
        boxes_.begin() + static_cast<std::ptrdiff_t>(begins[static_cast<std::size_t>(worker)]);
    for (std::size_t body = first; body < last; ++body) {
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

void SceneView::updateOutlines(const SceneViewContent& content) {
  std::vector<Primitive> edges;
  for (const std::uint32_t body :
       content.selected.first(std::min(kMostOutlines, content.selected.size()))) {
    if (body >= content.boxes.size()) continue;
    const std::vector<Primitive> box = wireframe(content.boxes[body], content.theme.selection,
                                                 kOutlineWidth * content.scale, content.space);
    edges.insert(edges.end(), box.begin(), box.end());
  }
  outlines_.lines = line_renderer_.upload(edges);
}

void SceneView::updateLines(const SceneViewContent& content) {
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

void SceneView::updateSurroundings(const SceneViewContent& content) {
  contents_ = boundsOf(boxes_, content.space.toView(content.world));
  // The floor lies behind whatever rests on it or sinks through it.
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

void SceneView::drawPicture(const Viewpoint& viewpoint) {
  gl_->Enable(GL_DEPTH_TEST);
  gl_->DepthFunc(GL_LEQUAL);
  gl_->DepthMask(GL_TRUE);
  gl_->Disable(GL_BLEND);
  gl_->Disable(GL_SCISSOR_TEST);
  gl_->Disable(GL_CULL_FACE);
  drawBoxes(viewpoint);

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

void SceneView::drawBoxes(const Viewpoint& viewpoint) {
  if (splatter_) {
    splatter_->draw(boxes_, viewpoint);
    framebuffer_->write(splatter_->colours(), splatter_->depths());
    framebuffer_->bind();
    return;
  }
  framebuffer_->bind();
  setClearColour(*gl_, viewpoint.haze);
  gl_->Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  box_renderer_.draw(box_buffer_, viewpoint);
}

void SceneView::drawFloor(const Viewpoint& viewpoint) const {
  // As far away as nothing at all: what has been drawn is before it.
  gl_->DepthRange(1, 1);
  box_renderer_.draw(floor_, viewpoint);
  gl_->Enable(GL_BLEND);
  line_renderer_.draw(grid_, viewpoint);
  gl_->DepthRange(0, 1);
}

void SceneView::drawLines(const LineLayer& layer, const Viewpoint& viewpoint) const {
  if (layer.behind != Behind::hidden) {
    gl_->DepthFunc(GL_GREATER);
    line_renderer_.draw(layer.lines, viewpoint, layer.behind == Behind::faint ? kFaint : 1);
    gl_->DepthFunc(GL_LEQUAL);
  }
  line_renderer_.draw(layer.lines, viewpoint);
}

void SceneView::drawAxes(const Viewpoint& viewpoint) const {
  const float scale = drawn_->scale;
  const std::array<float, 3> back = axesOf(viewpoint.camera).back;
  std::array<std::size_t, 3> order = {0, 1, 2};  // from the farthest to the nearest
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return back[a] < back[b]; });
  std::vector<Primitive> lines;
  for (const std::size_t axis : order) {
    Primitive line{{}, static_cast<float>(kAxisColours[axis]), {}, kAxesWidth * scale};
    line.to[axis] = 1;
    lines.push_back(line);
  }
  const Viewpoint corner = axesViewpoint(viewpoint, scale);
  const auto margin = static_cast<int>(kAxesMargin * scale);
  gl_->Viewport(margin, margin, corner.width, corner.height);
  line_renderer_.draw(line_renderer_.upload(lines), corner);
}

std::array<std::array<float, 2>, 3> axisTips(const Viewpoint& viewpoint, float scale) {
  const Viewpoint corner = axesViewpoint(viewpoint, scale);
  const float margin = std::trunc(kAxesMargin * scale);
  std::array<std::array<float, 2>, 3> tips{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::array<float, 3> tip{};
    tip[axis] = kAxesLabels;
    const std::array at = project(corner.camera, tip).value();
    tips[axis] = {margin + (at[0] + 1) / 2 * static_cast<float>(corner.width),
                  static_cast<float>(viewpoint.height) - margin -
                      (at[1] + 1) / 2 * static_cast<float>(corner.height)};
  }
  return tips;
}

}  // namespace broadmark
