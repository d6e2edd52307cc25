// Boxes and lines: from world coordinates to primitives, and by OpenGL to the screen.
#pragma once

#include <span>
#include <vector>

#include "box_look.h"
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

/// A box that is drawn at least `width` pixels wide.
Primitive boxPrimitive(const Aabb& box, Rgb colour, const ViewSpace& space,
                       float width = kBoxLook.smallest_pixels);

/// The twelve edges of a box.
std::vector<Primitive> wireframe(const Aabb& box, Rgb colour, float width, const ViewSpace& space);

/// A grid on the floor (lowest y) of a box, in squares of a tenth of its longer side.
std::vector<Primitive> floorGrid(const Aabb& box, Rgb colour, float width, const ViewSpace& space);

}  // namespace broadmark
