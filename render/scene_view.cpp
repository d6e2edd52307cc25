// OpenGL draws the scene, or the software renderer if OpenGL runs on the CPU.
#include "broadmark/render/scene_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>

#include "broadmark/render/framebuffer.h"
#include "primitive_renderer.h"
#include "scene_primitives.h"
#include "software_rasterizer.h"

namespace broadmark {
namespace {

/// Restores framebuffer and viewport on destruction.
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

bool splats(const Gl& gl, Technique technique) {
  return technique == Technique::splat ||
         (technique == Technique::automatic && isSoftwareRenderer(gl));
}

int samplesOf(const Gl& gl, int requested, bool is_splatting) {
  if (is_splatting) return 1;
  if (requested != 0) return requested;
  return isSoftwareRenderer(gl) ? 1 : Framebuffer::kSamples;
}

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

// The small axes in the lower left corner.
constexpr float kAxesMargin = 8;  ///< pixels, before scaling
constexpr float kAxesSide = 96;   ///< pixels
constexpr float kAxesWidth = 2.4F;

// Relative to the length of an axis.
constexpr float kAxesReach = 1.55F;  ///< half the side of the picture
constexpr float kAxesLabels = 1.28F;
constexpr float kAxesDistance = 8;  ///< distance of the eye

/// A square picture that shows the unit axes from the direction of `viewpoint`'s camera.
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

/// The axes as lines, from the farthest to the nearest.
std::vector<Primitive> axesCross(const Camera& camera, const Palette& theme, float scale) {
  const std::array<float, 3> back = axesOf(camera).back;
  std::array<std::size_t, 3> order = {0, 1, 2};
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return back[a] < back[b]; });
  std::vector<Primitive> lines;
  for (const std::size_t axis : order) {
    Primitive line{{}, static_cast<float>(theme.axis[axis]), {}, kAxesWidth * scale};
    line.to[axis] = 1;
    lines.push_back(line);
  }
  return lines;
}

}  // namespace

bool isSoftwareRenderer(const Gl& gl) {
  const auto* text = reinterpret_cast<const char*>(gl.GetString(GL_RENDERER));
  const std::string_view name = text != nullptr ? text : "";
  const auto name_contains = [&](const char* part) {
    return name.find(part) != std::string_view::npos;
  };
  return name_contains("llvmpipe") || name_contains("softpipe") || name_contains("SWR") ||
         name_contains("Software") || name_contains("SwiftShader");
}

/// Stores boxes and lines as primitives, and rebuilds them only if the content has changed.
class SceneView::Painter {
 public:
  Painter(const Gl& gl, const SceneViewOptions& options)
      : gl_(&gl),
        team_(std::max(1, options.threads)),
        rasterizer_(splats(gl, options.technique)
                        ? std::make_unique<SoftwareRasterizer>(team_, options.isa)
                        : nullptr),
        boxes_(boxRenderer(gl, options.max_batch)),
        lines_(lineRenderer(gl)) {}

  /// Applies changes of the content. Returns whether anything has changed.
  bool update(const SceneViewContent& content) {
    const ContentState state{content.bodies_revision, content.lines_revision, content.space,
                             content.world,           content.theme,          content.shows_world,
                             content.shows_grid,      content.shows_axes,     content.scale};
    if (drawn_state_ == state) return false;
    const bool all = !drawn_state_ || drawn_state_->space != state.space;
    const bool bodies = all || drawn_state_->bodies_revision != state.bodies_revision ||
                        drawn_state_->theme != state.theme || drawn_state_->scale != state.scale;
    const bool lines = all || drawn_state_->lines_revision != state.lines_revision ||
                       drawn_state_->scale != state.scale;
    if (bodies) {
      setBodies(scene_, content, team_);
      setOutlines(scene_, content);
    }
    if (lines) setLines(scene_, content);
    setSurroundings(scene_, content);
    bounds_ = boundsOf(scene_.boxes, content.space.toView(content.world));
    if (!rasterizer_) upload(bodies, lines);
    drawn_state_ = state;
    return true;
  }

  /// Draws the last updated content, and leaves `target` bound.
  void draw(const Viewpoint& viewpoint, const Framebuffer& target) {
    gl_->Disable(GL_SCISSOR_TEST);
    gl_->Disable(GL_CULL_FACE);
    gl_->BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    if (rasterizer_) {
      rasterizer_->draw(scene_, viewpoint);
      target.write(rasterizer_->colours());
      target.bind();
    } else {
      target.bind();
      drawByGl(viewpoint);
    }
    if (drawn_state_->shows_axes) drawAxes(viewpoint);
  }

  /// The bounds of bodies and world, in view space.
  [[nodiscard]] const Aabb& bounds() const { return bounds_; }
  [[nodiscard]] bool usesSoftwareRenderer() const { return rasterizer_ != nullptr; }

 private:
  /// All inputs that affect a picture, except its size and the camera.
  struct ContentState {
    std::uint64_t bodies_revision = 0;
    std::uint64_t lines_revision = 0;
    ViewSpace space;
    Aabb world;
    Palette theme;
    bool shows_world = false;
    bool shows_grid = false;
    bool shows_axes = false;
    float scale = 1;

    friend bool operator==(const ContentState&, const ContentState&) = default;
  };
  struct Uploaded {
    PrimitiveBuffer boxes;
    PrimitiveBuffer floor;
    PrimitiveBuffer glass;
    std::array<PrimitiveBuffer, ScenePrimitives::layers> lines;
  };
  void upload(bool bodies, bool lines) {
    const auto upload_layers = [&](std::initializer_list<ScenePrimitives::Layer> layers) {
      for (const ScenePrimitives::Layer layer : layers) {
        uploaded_.lines[layer] = lines_.upload(scene_.lines[layer].lines);
      }
    };
    if (bodies) {
      uploaded_.boxes = boxes_.upload(scene_.boxes);
      uploaded_.glass = boxes_.upload(scene_.glass);
      upload_layers({ScenePrimitives::outlines, ScenePrimitives::glass_edges});
    }
    if (lines) {
      upload_layers({ScenePrimitives::hidden, ScenePrimitives::faint, ScenePrimitives::shown});
    }
    uploaded_.floor = boxes_.upload(scene_.floor);
    upload_layers({ScenePrimitives::grid, ScenePrimitives::world});
  }

  void drawByGl(const Viewpoint& viewpoint) const {
    gl_->Enable(GL_DEPTH_TEST);
    gl_->DepthFunc(GL_LEQUAL);
    gl_->Disable(GL_BLEND);
    setClearColour(*gl_, viewpoint.haze);
    gl_->Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    boxes_.draw(uploaded_.boxes, viewpoint);

    gl_->DepthMask(GL_FALSE);
    gl_->ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_FALSE);  // the picture stays opaque
    // At the far end of the depth range, behind everything drawn so far.
    gl_->DepthRange(1, 1);
    boxes_.draw(uploaded_.floor, viewpoint);
    gl_->DepthRange(0, 1);
    gl_->Enable(GL_BLEND);
    boxes_.draw(uploaded_.glass, viewpoint, kBoxShading.glass);
    for (int layer = 0; layer < ScenePrimitives::layers; ++layer) {
      drawLines(static_cast<ScenePrimitives::Layer>(layer), viewpoint);
    }
    gl_->Disable(GL_BLEND);
    gl_->Disable(GL_DEPTH_TEST);
    gl_->DepthMask(GL_TRUE);
    gl_->ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  }

  void drawLines(ScenePrimitives::Layer layer, const Viewpoint& viewpoint) const {
    const LineLayer& style = scene_.lines[layer];
    const PrimitiveBuffer& lines = uploaded_.lines[layer];
    if (style.opacity_behind > 0) {
      gl_->DepthFunc(GL_GREATER);
      lines_.draw(lines, viewpoint, style.opacity_behind);
      gl_->DepthFunc(GL_LEQUAL);
    }
    if (style.where_no_box_is) gl_->DepthRange(1, 1);
    lines_.draw(lines, viewpoint, style.opacity);
    gl_->DepthRange(0, 1);
  }

  void drawAxes(const Viewpoint& viewpoint) const {
    const float scale = drawn_state_->scale;
    const Viewpoint corner = axesViewpoint(viewpoint, scale);
    const auto margin = static_cast<int>(kAxesMargin * scale);
    gl_->Viewport(margin, margin, corner.width, corner.height);
    gl_->Disable(GL_DEPTH_TEST);
    gl_->ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_FALSE);
    gl_->Enable(GL_BLEND);
    lines_.draw(lines_.upload(axesCross(viewpoint.camera, drawn_state_->theme, scale)), corner);
    gl_->Disable(GL_BLEND);
    gl_->ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  }

  const Gl* gl_;
  ThreadTeam team_;
  std::unique_ptr<SoftwareRasterizer> rasterizer_;  ///< null: OpenGL draws the scene
  PrimitiveRenderer boxes_;
  PrimitiveRenderer lines_;

  std::optional<ContentState> drawn_state_;
  ScenePrimitives scene_;
  Uploaded uploaded_;  ///< empty with the software renderer
  Aabb bounds_;
};

SceneView::SceneView(const Gl& gl, const SceneViewOptions& options)
    : gl_(&gl),
      painter_(std::make_unique<Painter>(gl, options)),
      samples_(samplesOf(gl, options.samples, painter_->usesSoftwareRenderer())) {
  resize(1, 1);
}

SceneView::~SceneView() = default;

void SceneView::resize(int width, int height) {
  width = std::max(width, 1);
  height = std::max(height, 1);
  if (framebuffer_ && framebuffer_->width() == width && framebuffer_->height() == height) return;
  const TargetGuard guard(*gl_);
  is_up_to_date_ = false;
  framebuffer_.reset();  // first, because both might not fit
  framebuffer_ = std::make_unique<Framebuffer>(*gl_, width, height, samples_);
}

void SceneView::draw(const SceneViewContent& content, const OrbitCamera& camera) {
  update(content);
  const double aspect = static_cast<double>(framebuffer_->width()) / framebuffer_->height();
  drawFrom(toCamera(camera, aspect, painter_->bounds()), content.theme);
}

void SceneView::draw(const SceneViewContent& content, const Camera& camera) {
  update(content);
  drawFrom(camera, content.theme);
}

void SceneView::update(const SceneViewContent& content) {
  if (painter_->update(content)) is_up_to_date_ = false;
}

void SceneView::drawFrom(const Camera& camera, const Palette& theme) {
  const Viewpoint viewpoint{camera, framebuffer_->width(), framebuffer_->height(),
                            theme.background};
  if (is_up_to_date_ && viewpoint == viewpoint_) return;
  viewpoint_ = viewpoint;
  const TargetGuard guard(*gl_);
  painter_->draw(viewpoint, *framebuffer_);
  framebuffer_->resolve();
  is_up_to_date_ = true;
}

GLuint SceneView::texture() const { return framebuffer_->texture(); }

Picture SceneView::read() const {
  const TargetGuard guard(*gl_);
  return framebuffer_->read();
}

bool SceneView::usesSoftwareRenderer() const { return painter_->usesSoftwareRenderer(); }

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
