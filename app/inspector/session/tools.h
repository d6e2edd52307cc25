// What the mouse does in the view with the bodies of the document, besides selecting them.
#pragma once

#include "broadmark/names.h"

namespace broadmark {

/// The first three are the gizmo's; `none`: the mouse only selects, and moves the camera.
enum class Tool { none, move, turn, scale, brush };
inline constexpr NameTable kTools{{NamedValue{Tool::none, "none"},
                                   {Tool::move, "move"},
                                   {Tool::turn, "turn"},
                                   {Tool::scale, "scale"},
                                   {Tool::brush, "brush"}}};

struct Tools {
  Tool tool = Tool::move;
  bool local = false;    ///< the gizmo's axes are those of the first selected body, not the world's
  bool snaps = false;    ///< drags go by steps; while Ctrl is down, the other way round
  double move_step = 1;  ///< in world units
  double turn_step = 15;  ///< in degrees
  double scale_step = 0.1;

  /// Takes a tool, or puts it down if it is the one in hand.
  void toggle(Tool which) { tool = tool == which ? Tool::none : which; }
};

}  // namespace broadmark
