// What lies under the pointer. Boxes are in world coordinates; the camera is in view space.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "broadmark/aabb.h"
#include "broadmark/render/primitive_renderer.h"

namespace broadmark {

/// A half-line in view space.
struct Ray {
  std::array<float, 3> origin{};
  /// Of length 1 along the view axis: a ray's parameter is the depth.
  std::array<float, 3> direction{};

  [[nodiscard]] std::array<float, 3> at(float depth) const;
};

/// The ray through a point of the picture: pixels from its upper left corner, (0.5, 0.5) being the
/// middle of the first one.
Ray rayThrough(const Viewpoint& viewpoint, float x, float y);

/// Which bodies count: all, or where not empty, those with a value other than 0.
using BodyMask = std::span<const std::uint8_t>;

struct PickedBody {
  std::uint32_t body = 0;
  float depth = 0;  ///< of the point hit, in view space: Ray::at()
};

/// The foremost body under a point of the picture, if any. Like the pictures, sees through what
/// surrounds the eye. A body counts as at least `smallest` pixels large on every side of its
/// middle, so that flat and tiny ones can be hit. One pass over all boxes.
std::optional<PickedBody> pickBody(std::span<const Aabb> boxes, const ViewSpace& space,
                                   const Viewpoint& viewpoint, float x, float y, BodyMask mask = {},
                                   float smallest = 2);

/// A part of the picture in pixels from its upper left corner, in any order of its corners.
struct ScreenRectangle {
  std::array<float, 2> from{};
  std::array<float, 2> to{};
};

/// What of a body has to lie in the rectangle.
enum class SelectBy { centre, whole };

/// The bodies in a rectangle of the picture, hidden behind others or not, in ascending order.
std::vector<std::uint32_t> bodiesWithin(std::span<const Aabb> boxes, const ViewSpace& space,
                                        const Viewpoint& viewpoint,
                                        const ScreenRectangle& rectangle, BodyMask mask = {},
                                        SelectBy by = SelectBy::centre);

}  // namespace broadmark
