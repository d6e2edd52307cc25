// The content of a SceneView as boxes and lines in view space.
#pragma once

#include <array>
#include <vector>

#include "broadmark/execution.h"
#include "broadmark/render/scene_view.h"
#include "look.h"
#include "primitive_renderer.h"

namespace broadmark {

/// Lines with the same visibility.
struct LineLayer {
  float opacity_behind = 0;      ///< of parts hidden by boxes
  bool where_no_box_is = false;  ///< behind all boxes, at any distance
  std::vector<Primitive> lines;
};

/// Drawn in the order of the members: boxes with depth test; the floor in pixels without a box;
/// lines, tested against the depths of the boxes.
struct ScenePrimitives {
  std::vector<Primitive> boxes;
  std::vector<Primitive> floor;  ///< a flat box, or none

  enum Layer { grid, world, hidden, faint, shown, outlines, layers };
  std::array<LineLayer, layers> lines = {
      LineLayer{.where_no_box_is = true},            // grid
      LineLayer{},                                   // world
      LineLayer{},                                   // hidden
      LineLayer{.opacity_behind = kLineLook.faint},  // faint
      LineLayer{.opacity_behind = 1},                // shown
      LineLayer{.opacity_behind = kLineLook.faint},  // outlines
  };
};

/// Each function replaces some of the primitives by the current content; this one the bodies.
void setBodies(ScenePrimitives& scene, const SceneViewContent& content, ThreadTeam& team);
/// Outlines of selected bodies.
void setOutlines(ScenePrimitives& scene, const SceneViewContent& content);
/// Lines and wire boxes.
void setLines(ScenePrimitives& scene, const SceneViewContent& content);
/// Floor, grid and the edges of the world.
void setSurroundings(ScenePrimitives& scene, const SceneViewContent& content);

}  // namespace broadmark
