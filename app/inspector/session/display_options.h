// Display options of the scene, for all views.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "broadmark/aabb.h"
#include "broadmark/render/colouring.h"

namespace broadmark {

/// Selects the bodies to draw by layer, size, colour class, and side of a clip plane.
struct BodyFilter {
  std::uint32_t hidden_layers = 0;   ///< one bit per layer
  std::uint64_t hidden_classes = 0;  ///< one bit per entry of the legend
  double smallest = 0;               ///< hides bodies whose longest edge is shorter
  double largest = 0;                ///< hides bodies whose longest edge is longer; 0: none
  int clip_axis = -1;                ///< axis normal to the clip plane: 0 to 2; -1: no plane
  double clip_at = 0.5;              ///< position of the plane, as a fraction of the world
  bool clip_below = false;           ///< hides the bodies below the plane, not above

  /// Whether the filter is active.
  [[nodiscard]] bool hides() const {
    return hidden_layers != 0 || hidden_classes != 0 || smallest > 0 || largest > 0 ||
           clip_axis >= 0;
  }
  /// Position of the clip plane on its axis.
  [[nodiscard]] double clipPosition(const Aabb& world) const {
    const auto axis = static_cast<std::size_t>(clip_axis);
    const double low = world.min[axis];
    return low + clip_at * (world.max[axis] - low);
  }

  friend bool operator==(const BodyFilter&, const BodyFilter&) = default;
};

/// Input of a filter; `layers` and `classes` may be empty.
struct FilterInput {
  std::span<const Aabb> boxes;
  std::span<const std::uint8_t> layers;
  std::span<const std::uint8_t> classes;
  Aabb world{};
};

/// Clears the `visible` flags of the bodies that the filter hides. O(bodies).
inline void hideBodies(const BodyFilter& filter, const FilterInput& bodies,
                       std::vector<std::uint8_t>& visible) {
  const double largest = filter.largest > 0 ? filter.largest : std::numeric_limits<double>::max();
  const bool by_size = filter.smallest > 0 || filter.largest > 0;
  const bool by_layer = filter.hidden_layers != 0 && bodies.layers.size() == bodies.boxes.size();
  const bool by_class = filter.hidden_classes != 0 && bodies.classes.size() == bodies.boxes.size();
  const bool clips = filter.clip_axis >= 0;
  const double plane = clips ? filter.clipPosition(bodies.world) : 0;
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

/// The clip plane as a flat box across the world; nothing without a plane.
inline std::optional<Aabb> clipPlane(const BodyFilter& filter, const Aabb& world) {
  if (filter.clip_axis < 0) return {};
  Aabb plane = world;
  const auto axis = static_cast<std::size_t>(filter.clip_axis);
  plane.min[axis] = plane.max[axis] = static_cast<float>(filter.clipPosition(world));
  return plane;
}

struct DisplayOptions {
  std::size_t colouring = 0;    ///< index of the colour mode
  bool hide_free = false;       ///< show only overlapping bodies
  bool pair_lines = false;      ///< lines between the centres of overlapping bodies…
  bool all_pair_lines = false;  ///< …for all pairs, not only the selection's
  BodyFilter filter;            ///< hides more bodies
  bool xray = false;            ///< the selection is visible through other bodies
  bool world_box = true;
  bool ground = true;
  bool axes = true;
  bool structure = false;      ///< draw the internal structure of the shown algorithm
  bool structure_near = true;  ///< only around the selection, if any
  int structure_level = -1;    ///< only this level; -1: all
  /// Colour the cells by their number of bodies, if the algorithm reports it.
  bool structure_population = true;

  [[nodiscard]] const ColourMode& colourMode() const {
    return colourModes()[colouring % colourModes().size()];
  }
  /// Selects the colour mode with this index. Classes hidden in another one are shown.
  void colourBy(std::size_t mode) {
    const std::size_t chosen = mode % colourModes().size();
    if (std::exchange(colouring, chosen) != chosen) {
      filter.hidden_classes = 0;
    }
  }
  void colourBy(std::string_view id) { colourBy(colourModeIndex(id)); }
  friend bool operator==(const DisplayOptions&, const DisplayOptions&) = default;
};

}  // namespace broadmark
