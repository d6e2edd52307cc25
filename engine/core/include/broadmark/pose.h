// Positions and rotations of bodies, and the boxes around them.
#pragma once

#include <array>
#include <span>

#include "broadmark/aabb.h"

namespace broadmark {

using Vec3 = std::array<float, 3>;
using Quaternion = std::array<float, 4>;  ///< x y z w

/// A body's position and rotation. Laid out as in a .posrot recording: 32 bytes, the fourth
/// component of the position is padding.
struct Pose {
  Vec3 position{};                              ///< of the centre
  alignas(16) Quaternion rotation{0, 0, 0, 1};  ///< of unit length

  friend bool operator==(const Pose&, const Pose&) = default;
};
static_assert(sizeof(Pose) == 32);

/// Half the size of the smallest axis-aligned box around a box with these half extents, rotated by
/// `rotation`: |R|·half extents, with no margin.
Vec3 rotatedExtents(const Vec3& half_extents, const Quaternion& rotation);

/// The box with this centre and these half extents.
constexpr Aabb boxAround(const Vec3& centre, const Vec3& half) {
  return {{centre[0] - half[0], centre[1] - half[1], centre[2] - half[2], 0},
          {centre[0] + half[0], centre[1] + half[1], centre[2] + half[2], 0}};
}

/// Frames with poses as well as boxes: the input of a .posrot recording. A second interface of a
/// FrameSource, advanced by its rewind() and next().
class PoseSource {
 public:
  virtual ~PoseSource() = default;

  /// The bodies' unrotated boxes in the initial pose. Callable, and valid, only while
  /// the initial pose is the latest frame.
  virtual std::span<const Aabb> unrotatedBoxes() = 0;
  /// The bodies' poses in the latest frame, from frame 1 on. Valid until the next frame. Throws
  /// InputError if the source has only boxes.
  virtual std::span<const Pose> poses() = 0;
};

}  // namespace broadmark
