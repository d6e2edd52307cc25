// How the scene is shown, in every view.
#pragma once

#include <cstddef>

#include "broadmark/render/colouring.h"
#include "inspector/session/body_filter.h"

namespace broadmark {

struct ViewOptions {
  std::size_t colouring = 0;  ///< which of the colour modes
  bool hide_free = false;     ///< show only what overlaps
  bool pair_lines = false;    ///< a line between the centres of overlapping bodies…
  bool lines_of_all = false;  ///< …of all pairs, not only those of the selection
  BodyFilter filter;          ///< who else is not shown
  bool xray = false;          ///< the selection is seen through what stands before it
  bool world_box = true;
  bool ground = true;
  bool axes = true;
  bool structure = false;      ///< what the shown algorithm draws of itself
  bool structure_near = true;  ///< only around the selection, if there is one
  int structure_level = -1;    ///< only this depth; -1: all
  /// Colours tell how many bodies its cells hold, where it says so.
  bool structure_population = true;

  [[nodiscard]] const ColourMode& colourMode() const {
    return colourModes()[colouring % colourModes().size()];
  }
  friend bool operator==(const ViewOptions&, const ViewOptions&) = default;
};

}  // namespace broadmark
