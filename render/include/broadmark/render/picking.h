// Picking bodies under the pointer. Boxes are in world coordinates, the camera is in view space.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "broadmark/aabb.h"
#include "broadmark/render/camera.h"

namespace broadmark {

/// A half-line in view space.
struct Ray {
  std::array<float, 3> origin{};
  /// Has length 1 along the view axis, so that the parameter of at() is the depth.
  std::array<float, 3> direction{};

  [[nodiscard]] std::array<float, 3> at(float depth) const;
};

/// The ray through a point of the picture, in pixels from its upper left corner; (0.5, 0.5) is the
/// centre of the first pixel.
Ray rayThrough(const Viewpoint& viewpoint, float x, float y);

/// Selects the present bodies with a value other than 0; if empty, all present bodies.
using BodyMask = std::span<const std::uint8_t>;

struct PickedBody {
  std::uint32_t body = 0;
  float depth = 0;  ///< of the hit point, in view space: Ray::at()
};

/// The foremost body under a point of the picture. Bodies around the eye are not hit, because they
/// are not drawn. Bodies are enlarged to at least `min_pixels` pixels from the centre to each side,
/// so that flat and tiny bodies can be hit. O(boxes).
std::optional<PickedBody> pickBody(std::span<const Aabb> boxes, const ViewSpace& space,
                                   const Viewpoint& viewpoint, float x, float y, BodyMask mask = {},
                                   float min_pixels = 2);

/// Two opposite corners, in any order, in pixels from the upper left corner of the picture.
struct ScreenRectangle {
  std::array<float, 2> from{};
  std::array<float, 2> to{};
};

/// The part of a body that must be inside the rectangle.
enum class SelectBy { centre, whole };

/// The bodies in a rectangle of the picture, including hidden ones, in ascending order.
std::vector<std::uint32_t> bodiesWithin(std::span<const Aabb> boxes, const ViewSpace& space,
                                        const Viewpoint& viewpoint,
                                        const ScreenRectangle& rectangle, BodyMask mask = {},
                                        SelectBy by = SelectBy::centre);

}  // namespace broadmark
