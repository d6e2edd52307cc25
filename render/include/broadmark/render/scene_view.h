// The 3D view of a scene: bodies as boxes, the world around them, lines and outlines. Draws
// off-screen into a texture, by the GPU; where OpenGL runs on the processor, by our own renderer.
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

/// How a line is drawn where bodies hide it.
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

/// What to draw. The spans are borrowed for one call of draw(). They are read only if their
/// revision or the space has changed.
struct SceneViewContent {
  ViewSpace space;
  Aabb world;

  std::uint64_t bodies_revision = 0;        ///< of the four that follow
  std::span<const Aabb> boxes;              ///< in the world; empty ones are not drawn
  std::span<const Rgb> colours;             ///< one for each box
  BodyMask visible;                         ///< one for each box, or empty: all
  std::span<const std::uint32_t> selected;  ///< bodies to be outlined, also invisible ones

  std::uint64_t lines_revision = 0;  ///< of the two that follow
  std::span<const SceneLine> lines;
  std::span<const SceneWireBox> wire_boxes;

  Palette theme = kLightPalette;  ///< of all but the bodies and lines
  bool shows_world = true;
  bool shows_grid = true;   ///< and the floor under it
  bool shows_axes = false;  ///< a small cross in the lower left corner, see axisTips()
  float scale = 1;          ///< of all widths and of the axes
};

/// How the scene is drawn: by OpenGL, or by our own renderer on the processor. `automatic`: by our
/// own if OpenGL runs on the processor, too.
enum class Technique { automatic, gl, splat };

struct SceneViewOptions {
  Technique technique = Technique::automatic;
  int samples = 0;  ///< a pixel, if OpenGL draws; 0: four on a GPU, else one
  int threads = static_cast<int>(std::thread::hardware_concurrency());
  Isa isa = bestIsa();
  std::size_t max_batch = std::numeric_limits<std::size_t>::max();  ///< boxes per draw call
};

/// Whether this context's OpenGL runs on the processor.
bool isSoftwareRenderer(const Gl& gl);

/// Needs its context current from construction to destruction. All members throw RenderError.
class SceneView {
 public:
  explicit SceneView(const Gl& gl, const SceneViewOptions& options = {});
  ~SceneView();
  SceneView(const SceneView&) = delete;
  SceneView& operator=(const SceneView&) = delete;

  /// Size of the picture in pixels; less than 1 becomes 1.
  void resize(int width, int height);

  /// Draws, unless nothing has changed since the last call. Like all members, restores framebuffer
  /// and viewport.
  void draw(const SceneViewContent& content, const Camera& camera);
  /// Near and far planes follow from the content.
  void draw(const SceneViewContent& content, const OrbitCamera& camera);

  /// The picture: a GL texture whose first row is at the bottom, until the next resize().
  [[nodiscard]] GLuint texture() const;
  [[nodiscard]] Picture read() const;

  /// The viewpoint drawn last, for picking.
  [[nodiscard]] const Viewpoint& viewpoint() const { return viewpoint_; }
  /// Whether our own renderer draws the scene.
  [[nodiscard]] bool isSplatting() const;

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

/// Where the names x, y and z belong in a picture drawn with shows_axes and that scale: pixels from
/// the upper left corner.
std::array<std::array<float, 2>, 3> axisTips(const Viewpoint& viewpoint, float scale);

}  // namespace broadmark
