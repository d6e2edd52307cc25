// Draws the content of a SceneView into the current target.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>

#include "box_renderer.h"
#include "broadmark/execution.h"
#include "broadmark/render/framebuffer.h"
#include "broadmark/render/scene_view.h"
#include "scene_primitives.h"
#include "splatter.h"

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
  /// Whether our own renderer draws the scene.
  [[nodiscard]] bool isSplatting() const { return splatter_ != nullptr; }

 private:
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
  /// The scene on the GPU.
  struct Uploaded {
    PrimitiveBuffer boxes;
    PrimitiveBuffer floor;
    std::array<PrimitiveBuffer, ScenePrimitives::layers> lines;
  };
  void upload(bool bodies, bool lines);
  void drawByGl(const Viewpoint& viewpoint) const;
  void drawLines(ScenePrimitives::Layer layer, const Viewpoint& viewpoint) const;
  void drawAxes(const Viewpoint& viewpoint) const;

  const Gl* gl_;
  ThreadTeam team_;
  std::unique_ptr<Splatter> splatter_;  ///< null: OpenGL draws the scene
  BoxRenderer box_renderer_;
  LineRenderer line_renderer_;

  std::optional<Drawn> drawn_;
  ScenePrimitives scene_;
  Uploaded uploaded_;  ///< empty if the splatter draws
  Aabb bounds_;
};

}  // namespace broadmark
