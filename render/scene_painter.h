// Draws the content of a SceneView into the current target.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "box_renderer.h"
#include "box_splatter.h"
#include "broadmark/execution.h"
#include "broadmark/render/framebuffer.h"
#include "broadmark/render/scene_view.h"

namespace broadmark {

/// Keeps boxes and lines as primitives and makes them again only when the content has changed.
/// Needs its context current from construction to destruction. All members throw RenderError.
class ScenePainter {
 public:
  ScenePainter(const Gl& gl, const SceneViewOptions& options);

  /// Takes over what has changed in the content. Whether anything has.
  bool update(const SceneViewContent& content);
  /// Draws what was last taken over, and leaves `target` bound.
  void draw(const Viewpoint& viewpoint, const Framebuffer& target);

  /// Bounds of bodies and world, in view space.
  [[nodiscard]] const Aabb& bounds() const { return bounds_; }
  /// Whether our own renderer draws the boxes.
  [[nodiscard]] bool isSplatting() const { return splatter_ != nullptr; }

 private:
  /// The lines of one kind of visibility.
  struct LineLayer {
    Behind behind = Behind::hidden;
    PrimitiveBuffer lines;
  };
  /// Everything that changes a picture, except its size and the camera.
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
  void updateBodies(const SceneViewContent& content);
  void updateOutlines(const SceneViewContent& content);
  void updateLines(const SceneViewContent& content);
  void updateSurroundings(const SceneViewContent& content);
  void drawBoxes(const Viewpoint& viewpoint, const Framebuffer& target);
  void drawFloor(const Viewpoint& viewpoint) const;
  void drawLines(const LineLayer& layer, const Viewpoint& viewpoint) const;
  void drawAxes(const Viewpoint& viewpoint) const;

  const Gl* gl_;
  ThreadTeam team_;
  std::unique_ptr<BoxSplatter> splatter_;  ///< null: OpenGL draws the boxes
  BoxRenderer box_renderer_;
  LineRenderer line_renderer_;

  std::optional<Drawn> drawn_;
  std::vector<Primitive> boxes_;
  Aabb bounds_;
  PrimitiveBuffer box_buffer_;
  PrimitiveBuffer floor_;
  PrimitiveBuffer grid_;
  LineLayer world_;
  LineLayer outlines_{Behind::faint, {}};
  LineLayer lines_[3] = {{Behind::hidden, {}}, {Behind::faint, {}}, {Behind::shown, {}}};
};

}  // namespace broadmark
