#include "broadmark/render/framebuffer.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace broadmark {
namespace {

GlObject makeRenderbuffer(const Gl& gl, int samples, GLenum format, int width, int height) {
  GlObject buffer = makeObject(gl.GenRenderbuffers, gl.DeleteRenderbuffers);
  gl.BindRenderbuffer(GL_RENDERBUFFER, buffer.get());
  gl.RenderbufferStorageMultisample(GL_RENDERBUFFER, samples, format, width, height);
  return buffer;
}

struct PixelFormat {
  GLint internal;   ///< on the GPU
  GLenum external;  ///< in CPU memory
  GLenum type;
};
constexpr PixelFormat kColour = {GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE};
constexpr PixelFormat kDepth = {GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT};

GlObject makeTexture(const Gl& gl, const PixelFormat& format, int width, int height) {
  GlObject texture = makeObject(gl.GenTextures, gl.DeleteTextures);
  gl.BindTexture(GL_TEXTURE_2D, texture.get());
  gl.TexImage2D(GL_TEXTURE_2D, 0, format.internal, width, height, 0, format.external, format.type,
                nullptr);
  for (const GLenum direction : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T}) {
    gl.TexParameteri(GL_TEXTURE_2D, direction, GL_CLAMP_TO_EDGE);
  }
  for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER}) {
    gl.TexParameteri(GL_TEXTURE_2D, filter, GL_NEAREST);  // without mipmaps
  }
  return texture;
}

}  // namespace

Framebuffer::Target Framebuffer::ifComplete(Target target) const {
  const bool complete = gl_->GetError() == GL_NO_ERROR &&
                        gl_->CheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
  return complete ? std::move(target) : Target{};
}

Framebuffer::Target Framebuffer::makeTextureTarget() const {
  Target target{makeTexture(*gl_, kColour, width_, height_),
                makeTexture(*gl_, kDepth, width_, height_),
                makeObject(gl_->GenFramebuffers, gl_->DeleteFramebuffers)};
  gl_->BindFramebuffer(GL_FRAMEBUFFER, target.framebuffer.get());
  gl_->FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D,
                            target.colour.get(), 0);
  gl_->FramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, target.depth.get(),
                            0);
  return ifComplete(std::move(target));
}

Framebuffer::Target Framebuffer::makeMultisampleTarget(int samples) const {
  Target target{makeRenderbuffer(*gl_, samples, GL_RGBA8, width_, height_),
                makeRenderbuffer(*gl_, samples, GL_DEPTH_COMPONENT24, width_, height_),
                makeObject(gl_->GenFramebuffers, gl_->DeleteFramebuffers)};
  gl_->BindFramebuffer(GL_FRAMEBUFFER, target.framebuffer.get());
  gl_->FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER,
                               target.colour.get());
  gl_->FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER,
                               target.depth.get());
  return ifComplete(std::move(target));
}

Framebuffer::Framebuffer(const Gl& gl, int width, int height, int samples)
    : gl_(&gl), width_(width), height_(height) {
  const int largest = gl.integer(GL_MAX_TEXTURE_SIZE);
  if (width > largest || height > largest) {
    throw RenderError(fmt::format("a picture of {} x {} is too large for this OpenGL (at most {})",
                                  width, height, largest));
  }
  resolved_ = makeTextureTarget();
  if (resolved_.framebuffer.get() == 0) {
    throw RenderError(fmt::format("OpenGL has no memory for a picture of {} x {}", width, height));
  }
  samples = std::min(samples, gl.integer(GL_MAX_SAMPLES));
  // If several samples per pixel do not fit, drawn_ is empty and drawing uses the textures.
  if (samples > 1) drawn_ = makeMultisampleTarget(samples);
}

void Framebuffer::bind() const {
  const Target& target = drawn_.framebuffer.get() != 0 ? drawn_ : resolved_;
  gl_->BindFramebuffer(GL_FRAMEBUFFER, target.framebuffer.get());
  gl_->Viewport(0, 0, width_, height_);
}

void Framebuffer::write(std::span<const std::uint32_t> rgba) const {
  gl_->PixelStorei(GL_UNPACK_ALIGNMENT, 4);
  gl_->BindTexture(GL_TEXTURE_2D, resolved_.colour.get());
  gl_->TexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width_, height_, kColour.external, kColour.type,
                     rgba.data());
  gl_->check("uploading a picture");
}

void Framebuffer::resolve() const {
  if (drawn_.framebuffer.get() == 0) return;
  gl_->BindFramebuffer(GL_READ_FRAMEBUFFER, drawn_.framebuffer.get());
  gl_->BindFramebuffer(GL_DRAW_FRAMEBUFFER, resolved_.framebuffer.get());
  gl_->BlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT,
                       GL_NEAREST);
}

Picture readPicture(const Gl& gl, int width, int height) {
  Picture picture{width, height, {}};
  const std::size_t row_bytes = static_cast<std::size_t>(width) * 4;
  picture.rgba.resize(row_bytes * static_cast<std::size_t>(height));
  gl.PixelStorei(GL_PACK_ALIGNMENT, 4);
  gl.ReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, picture.rgba.data());
  gl.check("reading the picture back");

  // Blending also changed the opacity.
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
  resolve();
  gl_->BindFramebuffer(GL_FRAMEBUFFER, resolved_.framebuffer.get());
  return readPicture(*gl_, width_, height_);
}

}  // namespace broadmark
