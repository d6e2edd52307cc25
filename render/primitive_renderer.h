// Many small primitives (boxes, lines) drawn by vertex pulling: each is two texels of a buffer
// texture, and the vertex shader finds its primitive and its corner from gl_VertexID. No vertex
// attributes, no indices; on software renderers and small boxes this beats instancing.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>
#include <vector>

#include "broadmark/debug_draw.h"
#include "broadmark/render/camera.h"
#include "broadmark/render/gl.h"

namespace broadmark {

/// Two RGBA32F texels, in view space.
struct Primitive {
  std::array<float, 3> from{};  ///< a box's minimum corner, a line's start
  float colour = 0;             ///< 0xRRGGBB as a number: exact in a float, unlike its bits, which
                                ///< would be denormals and may be flushed to 0
  std::array<float, 3> to{};
  float width = 0;  ///< of a line in pixels; of a box what it is at least drawn wide, likewise
};
static_assert(sizeof(Primitive) == 32);

/// Where and how a picture is drawn.
struct Viewpoint {
  Camera camera;
  int width = 1;   ///< pixels
  int height = 1;  ///< pixels
  Rgb haze = 0;    ///< what far things fade towards: the background

  friend bool operator==(const Viewpoint&, const Viewpoint&) = default;
};

/// Distance from the eye to what the camera looks at.
float focus(const Camera& camera);

/// Primitives on the GPU, of the kind that the renderer which made them draws.
class PrimitiveBuffer {
 private:
  friend class PrimitiveRenderer;
  struct Batch {
    GlObject buffer;
    GlObject texture;
    GLsizei vertices = 0;
  };
  std::vector<Batch> batches_;
};

/// Draws primitives of one kind from any viewpoint. Needs its context current from construction to
/// destruction.
class PrimitiveRenderer {
 public:
  /// `max_batch` primitives are drawn per call, or as many as the driver's buffer textures hold if
  /// that is less. Throws RenderError.
  PrimitiveRenderer(const Gl& gl, std::string_view vertex_source, std::string_view fragment_source,
                    int vertices_per_primitive,
                    std::size_t max_batch = std::numeric_limits<std::size_t>::max());

  /// Throws RenderError.
  [[nodiscard]] PrimitiveBuffer upload(std::span<const Primitive> primitives) const;
  /// Draws into the current framebuffer; the opacity counts for what is drawn with blending.
  /// Throws RenderError.
  void draw(const PrimitiveBuffer& primitives, const Viewpoint& viewpoint, float opacity = 1) const;

 protected:
  /// For setting what stays the same in all pictures.
  void use() const { gl_->UseProgram(program_.get()); }
  [[nodiscard]] GLint uniform(const char* name) const;

 private:
  PrimitiveBuffer::Batch makeBatch(std::span<const Primitive> primitives) const;

  const Gl* gl_;
  GlObject program_;
  GlObject vertex_array_;  // core profile wants one bound, even empty
  int vertices_per_primitive_;
  std::size_t batch_size_;
};

}  // namespace broadmark
