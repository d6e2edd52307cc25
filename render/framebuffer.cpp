#include "render/framebuffer.h"

#include <fmt/format.h>

#include <algorithm>

namespace broadmark {
namespace {

constexpr int kSamples = 4;

GlObject makeRenderbuffer(const Gl& gl, int samples, GLenum format, int width, int height) {
  GlObject buffer = makeObject(gl.GenRenderbuffers, gl.DeleteRenderbuffers);
  gl.BindRenderbuffer(GL_RENDERBUFFER, buffer.get());
  gl.RenderbufferStorageMultisample(GL_RENDERBUFFER, samples, format, width, height);
  return buffer;
}

}  // namespace

Framebuffer::Target Framebuffer::makeTarget(int samples, bool& complete) const {
  Target target{makeRenderbuffer(*gl_, samples, GL_RGBA8, width_, height_),
                makeRenderbuffer(*gl_, samples, GL_DEPTH_COMPONENT24, width_, height_),
                makeObject(gl_->GenFramebuffers, gl_->DeleteFramebuffers)};
  gl_->BindFramebuffer(GL_FRAMEBUFFER, target.framebuffer.get());
  gl_->FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER,
                               target.colour.get());
  gl_->FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER,
                               target.depth.get());
  complete = gl_->GetError() == GL_NO_ERROR &&
             gl_->CheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
  return target;
}

Framebuffer::Framebuffer(const Gl& gl, int width, int height)
    : gl_(&gl), width_(width), height_(height) {
  const int largest = gl.integer(GL_MAX_RENDERBUFFER_SIZE);
  if (width > largest || height > largest) {
    throw RenderError(fmt::format("a picture of {} x {} is too large for this OpenGL (at most {})",
                                  width, height, largest));
  }
  bool complete = false;
  resolved_ = makeTarget(0, complete);
  if (!complete) {
    throw RenderError(fmt::format("OpenGL has no room for a picture of {} x {}", width, height));
  }
  drawn_ = makeTarget(std::min(kSamples, gl.integer(GL_MAX_SAMPLES)), complete);
  // Too large for several samples a pixel: one each, drawn straight into the resolved target.
  if (!complete) drawn_ = {};
}

void Framebuffer::bind() const {
  const Target& target = drawn_.framebuffer.get() != 0 ? drawn_ : resolved_;
  gl_->BindFramebuffer(GL_FRAMEBUFFER, target.framebuffer.get());
  gl_->Viewport(0, 0, width_, height_);
}

Picture readPicture(const Gl& gl, int width, int height) {
  Picture picture{width, height, {}};
  const std::size_t row_bytes = static_cast<std::size_t>(width) * 4;
  picture.rgba.resize(row_bytes * static_cast<std::size_t>(height));
  gl.PixelStorei(GL_PACK_ALIGNMENT, 4);
  gl.ReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, picture.rgba.data());
  gl.check("reading the picture back");

  // What was drawn with blending has left its mark on the picture's opacity, too.
  for (std::size_t i = 3; i < picture.rgba.size(); i += 4) picture.rgba[i] = 255;
  // OpenGL's rows run from bottom to top.
  for (std::size_t top = 0, bottom = static_cast<std::size_t>(height) - 1; top < bottom;
       ++top, --bottom) {
    const auto row = [&](std::size_t index) {
      return picture.rgba.begin() + static_cast<std::ptrdiff_t>(index * row_bytes);
    };
    std::swap_ranges(row(top), row(top + 1), row(bottom));
  }
  return picture;
}

Picture Framebuffer::read() const {
  if (drawn_.framebuffer.get() != 0) {
    gl_->BindFramebuffer(GL_READ_FRAMEBUFFER, drawn_.framebuffer.get());
    gl_->BindFramebuffer(GL_DRAW_FRAMEBUFFER, resolved_.framebuffer.get());
    gl_->BlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT,
                         GL_NEAREST);
  }
  gl_->BindFramebuffer(GL_FRAMEBUFFER, resolved_.framebuffer.get());
  return readPicture(*gl_, width_, height_);
}

}  // namespace broadmark
