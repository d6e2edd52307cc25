#include "broadmark/render/scene_view.h"

#include <algorithm>
#include <string_view>

#include "broadmark/render/framebuffer.h"
#include "scene_painter.h"

namespace broadmark {
namespace {

/// Restores framebuffer and viewport.
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

int samplesOf(const Gl& gl, int wanted, bool is_splatting) {
  if (is_splatting) return 1;
  if (wanted != 0) return wanted;
  return isSoftwareRenderer(gl) ? 1 : Framebuffer::kSamples;
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
      painter_(std::make_unique<ScenePainter>(gl, options)),
      samples_(samplesOf(gl, options.samples, painter_->isSplatting())) {
  resize(1, 1);
}

SceneView::~SceneView() = default;

void SceneView::resize(int width, int height) {
  width = std::max(width, 1);
  height = std::max(height, 1);
  if (framebuffer_ && framebuffer_->width() == width && framebuffer_->height() == height) return;
  const TargetGuard guard(*gl_);
  is_up_to_date_ = false;
  framebuffer_.reset();  // first: both might not fit
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

void SceneView::drawFrom(const Camera& camera, const SceneTheme& theme) {
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

bool SceneView::isSplatting() const { return painter_->isSplatting(); }

}  // namespace broadmark
