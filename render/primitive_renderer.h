// Draws many small primitives (boxes, lines) by vertex pulling: a primitive is two texels of a
// texture, and the vertex shader computes primitive and corner from gl_VertexID, without
// vertex attributes or indices. Faster than instancing for small boxes and on software renderers.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <string_view>
#include <vector>

#include "broadmark/render/camera.h"
#include "broadmark/render/colour.h"
#include "broadmark/render/gl.h"

namespace broadmark {

/// Two RGBA32F texels, in view space.
struct Primitive {
  std::array<float, 3> from{};  ///< a box's minimum corner, a line's start
  float colour = 0;  ///< 0xRRGGBB as a number, exact in a float. Its bits would be a denormal,
                     ///< which drivers may flush to 0
  std::array<float, 3> to{};
  float width = 0;  ///< pixels: a line's width, or a box's minimum width
};
static_assert(sizeof(Primitive) == 32);

/// Primitives on the GPU. Only the renderer that uploaded them can draw them.
class PrimitiveBuffer {
 private:
  friend class PrimitiveRenderer;
  struct Batch {
    GlObject texture;
    GLsizei vertices = 0;
  };
  std::vector<Batch> batches_;
};

/// Draws primitives of one kind from any viewpoint. Requires its context to be current during
/// its lifetime.
class PrimitiveRenderer {
 public:
  /// Draws at most `max_batch` primitives per call, or fewer if the driver's textures are
  /// smaller. Throws RenderError.
  PrimitiveRenderer(const Gl& gl, std::string_view vertex_source, std::string_view fragment_source,
                    int vertices_per_primitive,
                    std::size_t max_batch = std::numeric_limits<std::size_t>::max());

  /// Throws RenderError.
  [[nodiscard]] PrimitiveBuffer upload(std::span<const Primitive> primitives) const;
  /// Draws into the current framebuffer. The opacity requires blending. Throws RenderError.
  void draw(const PrimitiveBuffer& primitives, const Viewpoint& viewpoint, float opacity = 1) const;

  /// Must be called before setting uniforms that are the same in all pictures.
  void use() const { gl_->UseProgram(program_.get()); }
  [[nodiscard]] GLint uniform(const char* name) const;

 private:
  PrimitiveBuffer::Batch makeBatch(std::span<const Primitive> primitives) const;

  const Gl* gl_;
  GlObject program_;
  GlObject vertex_array_;  // empty; the core profile requires a bound vertex array
  int vertices_per_primitive_;
  std::size_t batch_size_;
};

/// A renderer of solid boxes with dark edges. The shaders compute the shading and the edges, and
/// select the three faces towards the camera.
PrimitiveRenderer boxRenderer(const Gl& gl, std::size_t max_batch);
/// A renderer of straight lines of constant width in pixels, with smooth borders. Requires
/// blending.
PrimitiveRenderer lineRenderer(const Gl& gl);

}  // namespace broadmark
