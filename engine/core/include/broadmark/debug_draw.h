// What an algorithm draws of its own structure: grid cells, tree nodes, split planes, sort axes.
#pragma once

#include <array>
#include <cstdint>

#include "broadmark/aabb.h"

namespace broadmark {

/// What a drawn box or line is; the palette (assets/palette.txt) has a colour for each.
enum class StructureRole {
  cell,          ///< or a node
  cell_part,     ///< of a cell that is cut
  split,         ///< a split plane or a sort axis
  best_split,    ///< the chosen one of several
  moving_node,   ///< of bodies that move
  resting_node,  ///< of bodies at rest
};

/// Receives the drawing. The thread that runs the algorithm calls drawStructure() between frames.
class DebugDraw {
 public:
  virtual ~DebugDraw() = default;

  /// A cell or node. `level` is its depth (0 = root or only level), for filtering by depth.
  virtual void box(const Aabb&, StructureRole, int level) = 0;
  virtual void line(const std::array<float, 3>& from, const std::array<float, 3>& to,
                    StructureRole) = 0;
  /// A cell that holds so many bodies, more than none. What shows how crowded cells are gives it
  /// the colour of a scale instead.
  virtual void cell(const Aabb& bounds, int level, std::uint32_t /*population*/) {
    box(bounds, StructureRole::cell, level);
  }
  /// In how many tests of two boxes a body took part in the last frame; calls for a body add up. An
  /// algorithm that tells it of one body tells it of all, also of those with none, and counts as it
  /// draws: nothing that is timed should take longer for it.
  virtual void tests(std::uint32_t /*body*/, std::uint32_t /*count*/) {}
};

}  // namespace broadmark
