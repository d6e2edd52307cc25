// An own target to draw into and read back: contexts without a surface have none.
#pragma once

#include "render/gl.h"

namespace broadmark {

/// Reads what is in the framebuffer that is bound for reading, opaque. Throws RenderError.
Picture readPicture(const Gl& gl, int width, int height);

/// A picture-sized target with depth, four samples a pixel where the driver can.
class Framebuffer {
 public:
  /// Throws RenderError when the driver cannot hold a picture of that size.
  Framebuffer(const Gl& gl, int width, int height);

  /// Makes it the target of drawing and sets the viewport.
  void bind() const;
  /// The finished picture, opaque. Throws RenderError.
  [[nodiscard]] Picture read() const;

 private:
  struct Target {
    GlObject colour;
    GlObject depth;
    GlObject framebuffer;
  };
  /// Nothing is thrown for a target that cannot be had: `complete` says so.
  Target makeTarget(int samples, bool& complete) const;

  const Gl* gl_;
  int width_;
  int height_;
  Target drawn_;
  Target resolved_;
};

}  // namespace broadmark
