// What a scene is drawn from: the content of a SceneView as boxes and lines in view space.
#pragma once

#include <array>
#include <vector>

#include "broadmark/execution.h"
#include "broadmark/render/scene_view.h"
#include "look.h"
#include "primitive_renderer.h"

namespace broadmark {

/// Lines that are seen under the same conditions.
struct LineLayer {
  float opacity_behind = 0;      ///< of what boxes hide
  bool where_no_box_is = false;  ///< behind everything, however near
  std::vector<Primitive> lines;
};

/// Drawn in the order of the members: boxes with depth test; the floor wherever there is no box;
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

/// These replace some of the primitives by what the content says now.
void setBodies(ScenePrimitives& scene, const SceneViewContent& content, ThreadTeam& team);
/// Outlines of selected bodies.
void setOutlines(ScenePrimitives& scene, const SceneViewContent& content);
/// Lines and boxes of lines.
void setLines(ScenePrimitives& scene, const SceneViewContent& content);
/// Floor, grid and the edges of the world.
void setSurroundings(ScenePrimitives& scene, const SceneViewContent& content);

}  // namespace broadmark
