// A target to draw into, to show as a texture and to read back. Contexts without a surface have no
// target of their own.
#pragma once

#include <cstdint>
#include <span>

#include "broadmark/render/gl.h"

namespace broadmark {

/// Reads the framebuffer that is bound for reading; the picture is opaque. Throws RenderError.
Picture readPicture(const Gl& gl, int width, int height);

/// Colour and depth of one picture. Needs its context current from construction to destruction.
class Framebuffer {
 public:
  static constexpr int kSamples = 4;  ///< a pixel, by default

  /// With `samples` a pixel, or fewer if the driver cannot do so many. Throws RenderError if it
  /// cannot hold a picture of that size.
  Framebuffer(const Gl& gl, int width, int height, int samples = kSamples);

  /// Makes it the target of drawing and sets the viewport.
  void bind() const;
  /// Replaces the picture: RGBA8 in memory order, rows from bottom to top. Only with one sample a
  /// pixel. Throws RenderError.
  void write(std::span<const std::uint32_t> rgba) const;
  /// Brings texture() up to date with what has been drawn.
  void resolve() const;
  /// The picture as a GL texture, its first row at the bottom.
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
  // These do not throw: a target that the driver cannot make has framebuffer 0.
  [[nodiscard]] Target makeTextureTarget() const;
  [[nodiscard]] Target makeMultisampleTarget(int samples) const;
  [[nodiscard]] Target whereComplete(Target target) const;

  const Gl* gl_;
  int width_;
  int height_;
  Target drawn_;     ///< with several samples a pixel; empty without
  Target resolved_;  ///< textures
};

}  // namespace broadmark
