// The scene is drawn by OpenGL, or, where that runs on the processor, by the splatter.
#include "scene_painter.h"

#include <algorithm>

#include "axes_cross.h"
#include "colour.h"

namespace broadmark {
namespace {

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

}  // namespace

ScenePainter::ScenePainter(const Gl& gl, const SceneViewOptions& options)
    : gl_(&gl),
      team_(std::max(1, options.threads)),
      box_renderer_(gl, options.max_batch),
      line_renderer_(gl) {
  const bool splats = options.technique == Technique::splat ||
                      (options.technique == Technique::automatic && isSoftwareRenderer(gl));
  if (splats) splatter_ = std::make_unique<Splatter>(team_, options.isa);
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
    setBodies(scene_, content, team_);
    setOutlines(scene_, content);
  }
  if (lines) setLines(scene_, content);
  setSurroundings(scene_, content);
  bounds_ = boundsOf(scene_.boxes, content.space.toView(content.world));
  if (!splatter_) upload(bodies, lines);
  drawn_ = wanted;
  return true;
}

void ScenePainter::upload(bool bodies, bool lines) {
  const auto upload_layers = [&](std::initializer_list<ScenePrimitives::Layer> layers) {
    for (const ScenePrimitives::Layer layer : layers) {
      uploaded_.lines[layer] = line_renderer_.upload(scene_.lines[layer].lines);
    }
  };
  if (bodies) {
    uploaded_.boxes = box_renderer_.upload(scene_.boxes);
    upload_layers({ScenePrimitives::outlines});
  }
  if (lines) {
    upload_layers({ScenePrimitives::hidden, ScenePrimitives::faint, ScenePrimitives::shown});
  }
  uploaded_.floor = box_renderer_.upload(scene_.floor);
  upload_layers({ScenePrimitives::grid, ScenePrimitives::world});
}

void ScenePainter::draw(const Viewpoint& viewpoint, const Framebuffer& target) {
  gl_->Disable(GL_SCISSOR_TEST);
  gl_->Disable(GL_CULL_FACE);
  gl_->BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  if (splatter_) {
    splatter_->draw(scene_, viewpoint);
    target.write(splatter_->colours());
    target.bind();
  } else {
    target.bind();
    drawByGl(viewpoint);
  }
  if (drawn_->shows_axes) drawAxes(viewpoint);
}

void ScenePainter::drawByGl(const Viewpoint& viewpoint) const {
  gl_->Enable(GL_DEPTH_TEST);
  gl_->DepthFunc(GL_LEQUAL);
  gl_->Disable(GL_BLEND);
  setClearColour(*gl_, viewpoint.haze);
  gl_->Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  box_renderer_.draw(uploaded_.boxes, viewpoint);

  gl_->DepthMask(GL_FALSE);
  gl_->ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_FALSE);  // the picture stays opaque
  // At the far end of the depth range: everything drawn so far is in front of it.
  gl_->DepthRange(1, 1);
  box_renderer_.draw(uploaded_.floor, viewpoint);
  gl_->DepthRange(0, 1);
  gl_->Enable(GL_BLEND);
  for (int layer = 0; layer < ScenePrimitives::layers; ++layer) {
    drawLines(static_cast<ScenePrimitives::Layer>(layer), viewpoint);
  }
  gl_->Disable(GL_BLEND);
  gl_->Disable(GL_DEPTH_TEST);
  gl_->DepthMask(GL_TRUE);
  gl_->ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

void ScenePainter::drawLines(ScenePrimitives::Layer layer, const Viewpoint& viewpoint) const {
  const LineLayer& how = scene_.lines[layer];
  const PrimitiveBuffer& lines = uploaded_.lines[layer];
  if (how.opacity_behind > 0) {
    gl_->DepthFunc(GL_GREATER);
    line_renderer_.draw(lines, viewpoint, how.opacity_behind);
    gl_->DepthFunc(GL_LEQUAL);
  }
  if (how.where_no_box_is) gl_->DepthRange(1, 1);
  line_renderer_.draw(lines, viewpoint);
  gl_->DepthRange(0, 1);
}

void ScenePainter::drawAxes(const Viewpoint& viewpoint) const {
  const float scale = drawn_->scale;
  const Viewpoint corner = axesViewpoint(viewpoint, scale);
  const auto margin = static_cast<int>(kAxesMargin * scale);
  gl_->Viewport(margin, margin, corner.width, corner.height);
  gl_->Disable(GL_DEPTH_TEST);
  gl_->ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_FALSE);
  gl_->Enable(GL_BLEND);
  line_renderer_.draw(line_renderer_.upload(axesCross(viewpoint.camera, scale)), corner);
  gl_->Disable(GL_BLEND);
  gl_->ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

}  // namespace broadmark
