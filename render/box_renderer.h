// Boxes and lines, drawn by OpenGL.
#pragma once

#include <limits>

#include "primitive_renderer.h"

namespace broadmark {

/// Solid boxes with dark edges. The shaders do the shading and the edges, and choose the three
/// faces that look at the camera.
class BoxRenderer : public PrimitiveRenderer {
 public:
  explicit BoxRenderer(const Gl& gl,
                       std::size_t max_batch = std::numeric_limits<std::size_t>::max());
};

/// Straight lines of even width in pixels, with smooth borders. Draw them with blending.
class LineRenderer : public PrimitiveRenderer {
 public:
  explicit LineRenderer(const Gl& gl);
};

}  // namespace broadmark
