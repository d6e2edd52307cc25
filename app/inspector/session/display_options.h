// How the scene is shown, in every view.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
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
  [[nodiscard]] bool hides() const {
    return hidden_layers != 0 || hidden_classes != 0 || smallest > 0 || largest > 0 ||
           clip_axis >= 0;
  }
  /// Where the plane stands on its axis.
  [[nodiscard]] double clipPlace(const Aabb& world) const {
    const auto axis = static_cast<std::size_t>(clip_axis);
    const double low = world.min[axis];
    return low + clip_at * (world.max[axis] - low);
  }

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
inline void hideBodies(const BodyFilter& filter, const FilteredBodies& bodies,
                       std::vector<std::uint8_t>& visible) {
  const double largest = filter.largest > 0 ? filter.largest : std::numeric_limits<double>::max();
  const bool by_size = filter.smallest > 0 || filter.largest > 0;
  const bool by_layer = filter.hidden_layers != 0 && bodies.layers.size() == bodies.boxes.size();
  const bool by_class = filter.hidden_classes != 0 && bodies.classes.size() == bodies.boxes.size();
  const bool clips = filter.clip_axis >= 0;
  const double plane = clips ? filter.clipPlace(bodies.world) : 0;
  for (std::size_t body = 0; body < bodies.boxes.size(); ++body) {
    const Aabb& box = bodies.boxes[body];
    bool hidden = by_layer && ((filter.hidden_layers >> bodies.layers[body]) & 1U) != 0;
    hidden |= by_class && bodies.classes[body] < 64 &&
              ((filter.hidden_classes >> bodies.classes[body]) & 1U) != 0;
    if (by_size) {
      const double size = longestEdge(box);
      hidden |= size < filter.smallest || size > largest;
    }
    if (clips) {
      const double centre = centreOf(box, static_cast<std::size_t>(filter.clip_axis));
      hidden |= filter.clip_below ? centre < plane : centre > plane;
    }
    if (hidden) visible[body] = 0;
  }
}

/// The plane, as a flat box across the world; nothing without one.
inline std::optional<Aabb> clipPlane(const BodyFilter& filter, const Aabb& world) {
  if (filter.clip_axis < 0) return {};
  Aabb plane = world;
  const auto axis = static_cast<std::size_t>(filter.clip_axis);
  plane.min[axis] = plane.max[axis] = static_cast<float>(filter.clipPlace(world));
  return plane;
}

struct DisplayOptions {
  std::size_t colouring = 0;  ///< which of the colour modes
  bool hide_free = false;     ///< show only what overlaps
  bool pair_lines = false;    ///< a line between the centres of overlapping bodies…
  bool lines_of_all = false;  ///< …of all pairs, not only those of the selection
  BodyFilter filter;          ///< hides further bodies
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
  friend bool operator==(const DisplayOptions&, const DisplayOptions&) = default;
};

}  // namespace broadmark
