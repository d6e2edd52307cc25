// How the scene is shown, in every view.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "broadmark/aabb.h"
#include "broadmark/render/colouring.h"

namespace broadmark {

/// Which bodies of a crowd are drawn: those of some layers, sizes and colours, on one side of a
/// plane.
struct BodyFilter {
  std::uint32_t hidden_layers = 0;   ///< a bit each
  std::uint64_t hidden_classes = 0;  ///< a bit for each entry of the legend
  double smallest = 0;               ///< longest edges below it are hidden
  double largest = 0;                ///< longest edges above it are hidden; 0: none
  int clip_axis = -1;                ///< across which a plane stands: 0 to 2; -1: there is none
  double clip_at = 0.5;              ///< where it stands, as a share of the world
  bool clip_below = false;           ///< hides what is below the plane, not above

  /// Whether it hides anybody.
  [[nodiscard]] bool hides() const;

  friend bool operator==(const BodyFilter&, const BodyFilter&) = default;
};

/// What a filter looks at; `layers` and `classes` may be empty.
struct FilteredBodies {
  std::span<const Aabb> boxes;
  std::span<const std::uint8_t> layers;
  std::span<const std::uint8_t> classes;
  Aabb world{};
};

/// Clears the marks of those that the filter hides; `visible` has one for each body. O(bodies).
void hideBodies(const BodyFilter& filter, const FilteredBodies& bodies,
                std::vector<std::uint8_t>& visible);

/// The plane, as a flat box across the world; nothing without one.
std::optional<Aabb> clipPlane(const BodyFilter& filter, const Aabb& world);

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
