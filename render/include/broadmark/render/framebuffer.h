// An own target to draw into, to show as a texture and to read back: contexts without a surface
// have none.
#pragma once

#include <cstdint>
#include <span>

#include "broadmark/render/gl.h"

namespace broadmark {

/// Reads what is in the framebuffer that is bound for reading, opaque. Throws RenderError.
Picture readPicture(const Gl& gl, int width, int height);

/// A picture-sized target with depth.
class Framebuffer {
 public:
  static constexpr int kSamples = 4;  ///< what is asked for by default

  /// With so many samples a pixel, or fewer where the driver cannot. Throws RenderError when it
  /// cannot hold a picture of that size.
  Framebuffer(const Gl& gl, int width, int height, int samples = kSamples);

  /// Makes it the target of drawing and sets the viewport.
  void bind() const;
  /// Puts a picture and its depths (0 to 1) in place of what has been drawn: RGBA8 in memory order,
  /// rows from bottom to top. Only with one sample a pixel. Throws RenderError.
  void write(std::span<const std::uint32_t> rgba, std::span<const float> depths) const;
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
  /// Nothing is thrown for a target that cannot be had: its framebuffer is then 0.
  [[nodiscard]] Target makeTextureTarget() const;
  [[nodiscard]] Target makeMultisampleTarget(int samples) const;
  [[nodiscard]] Target whereComplete(Target target) const;

  const Gl* gl_;
  int width_;
  int height_;
  Target drawn_;     ///< with several samples a pixel, if any
  Target resolved_;  ///< textures
};

}  // namespace broadmark
