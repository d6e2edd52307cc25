// The 3D view of a scene: bodies as boxes, the world around them, lines and outlines among them.
// Draws off-screen into a texture, on the GPU or, where OpenGL is emulated, mostly on the
// processor.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <thread>
#include <vector>

#include "broadmark/debug_draw.h"
#include "broadmark/execution.h"
#include "broadmark/render/box_renderer.h"
#include "broadmark/render/box_splatter.h"
#include "broadmark/render/framebuffer.h"
#include "broadmark/render/orbit_camera.h"
#include "broadmark/render/picking.h"

namespace broadmark {

/// The colours of what surrounds the bodies.
struct SceneTheme {
  Rgb background = 0;
  Rgb floor = 0;
  Rgb grid = 0;
  Rgb world = 0;      ///< edges of the world
  Rgb selection = 0;  ///< outlines and tint of what is selected

  friend bool operator==(const SceneTheme&, const SceneTheme&) = default;
};
inline constexpr SceneTheme kLightScene = {0xF5F6F8, 0xE9ECF0, 0xC6CED8, 0x8A97A6, 0x0B5FD9};
inline constexpr SceneTheme kDarkScene = {0x1B1F24, 0x23282E, 0x363E47, 0x6B7785, 0x5AB0FF};

/// The axes' colours: x, y, z.
inline constexpr Rgb kAxisColours[3] = {0xD64545, 0x3D9A50, 0x3B7DD8};

/// What is seen of a line where bodies are before it.
enum class Behind { hidden, faint, shown };

/// A straight line in the world.
struct SceneLine {
  std::array<float, 3> from{};
  std::array<float, 3> to{};
  Rgb colour = 0;
  float width = 1;  ///< pixels, before SceneViewContent::scale
  Behind behind = Behind::hidden;
};

/// The twelve edges of a box in the world.
struct SceneWireBox {
  Aabb box;
  Rgb colour = 0;
  float width = 1;
  Behind behind = Behind::hidden;
};

/// What is to be seen. The spans are borrowed for one call of draw(); they are read only when the
/// revision beside them, or the space, has changed.
struct SceneViewContent {
  ViewSpace space;
  Aabb world;

  std::uint64_t bodies_revision = 0;        ///< of the four that follow
  std::span<const Aabb> boxes;              ///< in the world
  std::span<const Rgb> colours;             ///< one for each box
  BodyMask visible;                         ///< one for each box, or empty: all
  std::span<const std::uint32_t> selected;  ///< bodies to be outlined, hidden ones as well

  std::uint64_t lines_revision = 0;  ///< of the two that follow
  std::span<const SceneLine> lines;
  std::span<const SceneWireBox> wire_boxes;

  SceneTheme theme = kLightScene;
  bool shows_world = true;
  bool shows_grid = true;   ///< and the floor under it
  bool shows_axes = false;  ///< a small cross of them in the lower left corner, see axisTips()
  float scale = 1;          ///< of all widths and of the axes
};

/// How boxes are drawn. `automatic`: on the processor when OpenGL is emulated there, else by
/// OpenGL.
enum class Technique { automatic, gl, splat };

struct SceneViewOptions {
  Technique technique = Technique::automatic;
  int samples = 0;  ///< a pixel, by OpenGL; 0: four on a GPU, else one
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

  /// Size of the picture in pixels; at least 1 x 1 is made of it.
  void resize(int width, int height);

  /// Draws; nothing happens when nothing has changed since the last time. Like all members, leaves
  /// the framebuffer and the viewport that were set.
  void draw(const SceneViewContent& content, const Camera& camera);
  /// With the near and far planes that suit the content.
  void draw(const SceneViewContent& content, const OrbitCamera& camera);

  /// The picture: a GL texture whose first row is at the bottom, until the next resize().
  [[nodiscard]] GLuint texture() const { return framebuffer_->texture(); }
  [[nodiscard]] Picture read() const;

  /// What was drawn last, for picking.
  [[nodiscard]] const Viewpoint& viewpoint() const { return viewpoint_; }
  /// Whether the processor draws the boxes.
  [[nodiscard]] bool isSplatting() const { return splatter_ != nullptr; }

 private:
  /// The lines of one kind of visibility.
  struct LineLayer {
    Behind behind = Behind::hidden;
    PrimitiveBuffer lines;
  };
  /// All that changes a picture, the size apart.
  struct Drawn {
    std::uint64_t bodies_revision = 0;
    std::uint64_t lines_revision = 0;
    ViewSpace space;
    Aabb world;
    SceneTheme theme;
    bool shows_world = false;
    bool shows_grid = false;
    bool shows_axes = false;
    float scale = 1;

    friend bool operator==(const Drawn&, const Drawn&) = default;
  };
  void update(const SceneViewContent& content);
  void updateBodies(const SceneViewContent& content);
  void updateOutlines(const SceneViewContent& content);
  void updateLines(const SceneViewContent& content);
  void updateSurroundings(const SceneViewContent& content);
  void drawPicture(const Viewpoint& viewpoint);
  void drawBoxes(const Viewpoint& viewpoint);
  void drawFloor(const Viewpoint& viewpoint) const;
  void drawLines(const LineLayer& layer, const Viewpoint& viewpoint) const;
  void drawAxes(const Viewpoint& viewpoint) const;

  const Gl* gl_;
  bool is_software_;
  int samples_;
  ThreadTeam team_;
  std::unique_ptr<BoxSplatter> splatter_;  // null: OpenGL draws the boxes
  BoxRenderer box_renderer_;
  LineRenderer line_renderer_;
  std::unique_ptr<Framebuffer> framebuffer_;

  std::optional<Drawn> drawn_;
  bool is_up_to_date_ = false;
  Viewpoint viewpoint_;
  std::vector<Primitive> boxes_;
  Aabb contents_;  ///< bounds of bodies and world, in view space
  PrimitiveBuffer box_buffer_;
  PrimitiveBuffer floor_;
  PrimitiveBuffer grid_;
  LineLayer world_;
  LineLayer outlines_{Behind::faint, {}};
  LineLayer lines_[3] = {{Behind::hidden, {}}, {Behind::faint, {}}, {Behind::shown, {}}};
};

/// Where the axes' names belong in a picture drawn with shows_axes and that scale: pixels from the
/// upper left corner, for x, y and z.
std::array<std::array<float, 2>, 3> axisTips(const Viewpoint& viewpoint, float scale);

}  // namespace broadmark
