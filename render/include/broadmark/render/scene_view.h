// The 3D view of a scene: bodies as boxes, the world around them, lines and outlines. Draws
// off-screen into a texture, on the GPU, or with the software renderer if OpenGL runs on the CPU.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <thread>

#include "broadmark/execution.h"
#include "broadmark/render/camera.h"
#include "broadmark/render/gl.h"
#include "broadmark/render/orbit_camera.h"
#include "broadmark/render/palette.h"
#include "broadmark/render/picking.h"

namespace broadmark {

class Framebuffer;

/// The style of a line behind bodies.
enum class OcclusionStyle { hidden, faint, shown };

/// A straight line in the world.
struct SceneLine {
  std::array<float, 3> from{};
  std::array<float, 3> to{};
  Rgb colour = 0;
  float width = 1;  ///< pixels, before SceneViewContent::scale
  OcclusionStyle behind = OcclusionStyle::hidden;
};

/// The twelve edges of a box in the world.
struct SceneWireBox {
  Aabb box;
  Rgb colour = 0;
  float width = 1;
  OcclusionStyle behind = OcclusionStyle::hidden;
};

/// The content of the view. The spans must be valid during draw(), which reads a span only if its
/// revision or the space has changed.
struct SceneViewContent {
  ViewSpace space;
  Aabb world;

  std::uint64_t bodies_revision = 0;        ///< of the next five members
  std::span<const Aabb> boxes;              ///< in the world; empty boxes are not drawn
  std::span<const Rgb> colours;             ///< by box
  BodyMask visible;                         ///< by box; empty: all are visible
  BodyMask glass;                           ///< by box, transparent ones; empty: none is
  std::span<const std::uint32_t> selected;  ///< outlined bodies, including invisible ones

  std::uint64_t lines_revision = 0;  ///< of the next two members
  std::span<const SceneLine> lines;
  std::span<const SceneWireBox> wire_boxes;

  Palette theme = kLightPalette;  ///< of everything except bodies and lines
  bool shows_world = true;
  bool shows_grid = true;   ///< with the floor under it
  bool shows_axes = false;  ///< small axes in the lower left corner, see axisTips()
  float scale = 1;          ///< of all widths and of the axes
};

/// The renderer: OpenGL, or the software renderer. `automatic`: the software renderer if OpenGL
/// also runs on the CPU.
enum class Technique { automatic, gl, splat };

struct SceneViewOptions {
  Technique technique = Technique::automatic;
  int samples = 0;  ///< per pixel, for OpenGL; 0: four on a GPU, else one
  int threads = static_cast<int>(std::thread::hardware_concurrency());
  Isa isa = bestIsa();
  std::size_t max_batch = std::numeric_limits<std::size_t>::max();  ///< boxes per draw call
};

/// Whether this context's OpenGL runs on the CPU.
bool isSoftwareRenderer(const Gl& gl);

/// Draws a scene. Requires its context to be current during its lifetime. All members may throw
/// RenderError.
class SceneView {
 public:
  explicit SceneView(const Gl& gl, const SceneViewOptions& options = {});
  ~SceneView();
  SceneView(const SceneView&) = delete;
  SceneView& operator=(const SceneView&) = delete;

  /// Sets the size of the picture in pixels, at least 1.
  void resize(int width, int height);

  /// Draws if anything has changed since the last call. Like all members, restores framebuffer and
  /// viewport.
  void draw(const SceneViewContent& content, const Camera& camera);
  /// Derives near and far planes from the content.
  void draw(const SceneViewContent& content, const OrbitCamera& camera);

  /// The picture as a GL texture with the first row at the bottom, valid until the next resize().
  [[nodiscard]] GLuint texture() const;
  [[nodiscard]] Picture read() const;

  /// The viewpoint of the last draw(), for picking.
  [[nodiscard]] const Viewpoint& viewpoint() const { return viewpoint_; }
  /// Whether the software renderer draws the scene.
  [[nodiscard]] bool usesSoftwareRenderer() const;

 private:
  class Painter;

  void update(const SceneViewContent& content);
  void drawFrom(const Camera& camera, const Palette& theme);

  const Gl* gl_;
  std::unique_ptr<Painter> painter_;
  int samples_;
  std::unique_ptr<Framebuffer> framebuffer_;
  bool is_up_to_date_ = false;
  Viewpoint viewpoint_;
};

/// The positions of the labels x, y and z in a picture with shows_axes and this scale, in pixels
/// from the upper left corner.
std::array<std::array<float, 2>, 3> axisTips(const Viewpoint& viewpoint, float scale);

}  // namespace broadmark
