// The content of a SceneView as boxes and lines in view space.
#pragma once

#include <array>
#include <vector>

#include "broadmark/execution.h"
#include "broadmark/render/scene_view.h"
#include "primitive_renderer.h"
#include "shading.h"

namespace broadmark {

/// Lines with the same visibility.
struct LineLayer {
  float opacity = 1;
  float opacity_behind = 0;      ///< of parts hidden by boxes
  bool where_no_box_is = false;  ///< behind all boxes, at any distance
  std::vector<Primitive> lines;
};

/// Primitives, drawn in the order of the members: boxes with depth test; the floor in pixels
/// without a box; glass, then lines, tested against the depths of the boxes.
struct ScenePrimitives {
  std::vector<Primitive> boxes;
  std::vector<Primitive> floor;  ///< a flat box, or none
  std::vector<Primitive> glass;  ///< transparent boxes, which hide nothing

  enum Layer { grid, world, glass_edges, hidden, faint, shown, outlines, layers };
  std::array<LineLayer, layers> lines = {
      LineLayer{.where_no_box_is = true},               // grid
      LineLayer{},                                      // world
      LineLayer{.opacity = kLineShading.glass},         // glass_edges
      LineLayer{},                                      // hidden
      LineLayer{.opacity_behind = kLineShading.faint},  // faint
      LineLayer{.opacity_behind = 1},                   // shown
      LineLayer{.opacity_behind = kLineShading.faint},  // outlines
  };
};

/// Sets the bodies. Like the other functions, replaces only these primitives.
void setBodies(ScenePrimitives& scene, const SceneViewContent& content, ThreadTeam& team);
void setOutlines(ScenePrimitives& scene, const SceneViewContent& content);
void setLines(ScenePrimitives& scene, const SceneViewContent& content);
void setSurroundings(ScenePrimitives& scene, const SceneViewContent& content);

}  // namespace broadmark
