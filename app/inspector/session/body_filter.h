// Which bodies of a crowd are drawn: those of some layers, sizes and colours, on one side of a
// plane.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "broadmark/aabb.h"

namespace broadmark {

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

}  // namespace broadmark
