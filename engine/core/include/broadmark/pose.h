// Positions and rotations of bodies, and the boxes around them.
//
// Example:
//
//   const Pose pose{{0, 2, 0}, {0, 0, 0.7071068F, 0.7071068F}};  // turned by 90° about z
//   const Vec3 half = rotatedExtents({3, 1, 1}, pose.rotation);  // about (1, 3, 1)
//   const Aabb box = boxAround(pose.position, half);
#pragma once

#include <array>
#include <span>

#include "broadmark/aabb.h"

namespace broadmark {

using Vec3 = std::array<float, 3>;        ///< x y z
using Quaternion = std::array<float, 4>;  ///< x y z w

/// A body's position and rotation. Laid out as in a .posrot recording: 32 bytes, the fourth
/// component of the position is padding.
struct Pose {
  Vec3 position{};                              ///< of the centre, in world units
  alignas(16) Quaternion rotation{0, 0, 0, 1};  ///< of unit length

  friend bool operator==(const Pose&, const Pose&) = default;
};
static_assert(sizeof(Pose) == 32);

/// Half the size of the smallest axis-aligned box around a box with these half extents, rotated by
/// `rotation`, of unit length: |R|·half extents, with no margin for rounding.
Vec3 rotatedExtents(const Vec3& half_extents, const Quaternion& rotation);

/// The box with this centre and these half extents. Bounds are rounded to the nearest float.
constexpr Aabb boxAround(const Vec3& centre, const Vec3& half) {
  return {{centre[0] - half[0], centre[1] - half[1], centre[2] - half[2], 0},
          {centre[0] + half[0], centre[1] + half[1], centre[2] + half[2], 0}};
}

/// Frames with poses as well as boxes: the input of a .posrot recording. A second interface of a
/// FrameSource, advanced by its rewind() and next().
class PoseSource {
 public:
  virtual ~PoseSource() = default;

  /// The bodies' unrotated boxes in the initial pose, by body. Callable, and valid, only while the
  /// initial pose is the latest frame.
  virtual std::span<const Aabb> unrotatedBoxes() = 0;
  /// The bodies' poses in the latest frame, by body, from frame 1 on. Valid until the next frame.
  /// Throws InputError if the source has only boxes.
  virtual std::span<const Pose> poses() = 0;
};

}  // namespace broadmark
