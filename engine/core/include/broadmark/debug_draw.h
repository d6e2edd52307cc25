// Debug drawing of an algorithm's structure: grid cells, tree nodes, split planes, sort axes.
//
// Example:
//
//   // In an algorithm, whose drawing the inspector shows:
//   const auto draw_structure = [](DebugDraw& draw, const Aabb& world, std::uint32_t bodies) {
//     draw.cell(world, 0, bodies);
//     draw.line({world.min[0], 0, 0}, {world.max[0], 0, 0}, StructureRole::split);
//   };
#pragma once

#include <array>
#include <cstdint>

#include "broadmark/aabb.h"

namespace broadmark {

/// The role of a drawn box or line; the palette (assets/palette.txt) has a colour for each.
enum class StructureRole {
  cell,          ///< or a node
  cell_part,     ///< part of a divided cell
  split,         ///< a split plane or a sort axis
  best_split,    ///< the chosen one of several splits
  moving_node,   ///< of bodies that move
  resting_node,  ///< of bodies at rest
};

/// Receives the drawing. The thread that runs the algorithm calls drawStructure() between frames.
class DebugDraw {
 public:
  virtual ~DebugDraw() = default;

  /// A cell or node, in world units. `level` is its depth (0 = root or only level), for filtering
  /// by depth.
  virtual void box(const Aabb&, StructureRole, int level) = 0;
  /// A line between two points, in world units.
  virtual void line(const std::array<float, 3>& from, const std::array<float, 3>& to,
                    StructureRole) = 0;
  /// A cell with `population` > 0 bodies. Views of the cells' occupancy colour it by a scale
  /// instead. By default drawn as a box.
  virtual void cell(const Aabb& bounds, int level, std::uint32_t /*population*/) {
    box(bounds, StructureRole::cell, level);
  }
  /// The number of box tests with a body in the last frame; calls for a body add up. An algorithm
  /// either reports all bodies, also those with no tests, or none. It counts during drawing, so
  /// that timed code does no extra work.
  virtual void tests(std::uint32_t /*body*/, std::uint32_t /*count*/) {}
};

}  // namespace broadmark
