// A render target that can be shown as a texture and read back. Contexts without a surface have no
// default framebuffer.
#pragma once

#include <cstdint>
#include <span>

#include "broadmark/render/gl.h"

namespace broadmark {

/// Reads the framebuffer bound for reading, as an opaque picture. Throws RenderError.
Picture readPicture(const Gl& gl, int width, int height);

/// Colour and depth of a picture. Requires its context to be current during its lifetime.
class Framebuffer {
 public:
  static constexpr int kSamples = 4;  ///< default per pixel

  /// `samples`: per pixel, reduced to the driver's maximum. Throws RenderError if the driver does
  /// not support this size.
  Framebuffer(const Gl& gl, int width, int height, int samples = kSamples);

  /// Binds this as the draw target and sets the viewport.
  void bind() const;
  /// Replaces the picture: RGBA8 in memory order, rows from bottom to top. Only with one sample per
  /// pixel. Throws RenderError.
  void write(std::span<const std::uint32_t> rgba) const;
  /// Updates texture() with the drawn picture.
  void resolve() const;
  /// The picture as a GL texture, with the first row at the bottom.
  [[nodiscard]] GLuint texture() const { return resolved_.colour.get(); }
  /// The finished picture, opaque. Throws RenderError.
  [[nodiscard]] Picture read() const;

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }

 private:
  struct Target {
    GlObject colour;
    GlObject depth;
    GlObject framebuffer;
  };
  // These functions do not throw: the framebuffer is 0 if the driver cannot create the target.
  [[nodiscard]] Target makeTextureTarget() const;
  [[nodiscard]] Target makeMultisampleTarget(int samples) const;
  [[nodiscard]] Target ifComplete(Target target) const;

  const Gl* gl_;
  int width_;
  int height_;
  Target drawn_;     ///< with several samples per pixel, or empty
  Target resolved_;  ///< textures
};

}  // namespace broadmark
