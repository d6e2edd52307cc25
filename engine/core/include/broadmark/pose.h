// Where bodies are and how they are turned, and the boxes around them.
#pragma once

#include <array>
#include <span>

#include "broadmark/aabb.h"

namespace broadmark {

using Vec3 = std::array<float, 3>;
using Quaternion = std::array<float, 4>;  ///< x y z w

/// Where a body is and how it is turned. Lies in memory as in a .posrot recording: 32 bytes, the
/// fourth component of the position is padding.
struct Pose {
  Vec3 position{};                              ///< of the centre
  alignas(16) Quaternion rotation{0, 0, 0, 1};  ///< of unit length

  friend bool operator==(const Pose&, const Pose&) = default;
};
static_assert(sizeof(Pose) == 32);

/// Half the size of the smallest axis-aligned box around a box with these half extents, turned by
/// `rotation`: |R|·half extents, with no margin.
Vec3 turnedExtents(const Vec3& half_extents, const Quaternion& rotation);

/// The box with this centre and half its size.
constexpr Aabb boxAround(const Vec3& centre, const Vec3& half) {
  return {{centre[0] - half[0], centre[1] - half[1], centre[2] - half[2], 0},
          {centre[0] + half[0], centre[1] + half[1], centre[2] + half[2], 0}};
}

/// Frames of which more is known than boxes: what a .posrot recording is made from. Stands beside
/// FrameSource, whose rewind() and next() move it on.
class PoseSource {
 public:
  virtual ~PoseSource() = default;

  /// The bodies' boxes in the initial pose, but unturned: their size. Only to be asked for while
  /// the initial pose is the frame handed out last; valid as long.
  virtual std::span<const Aabb> unturnedBoxes() = 0;
  /// The bodies' poses in the frame handed out last, from frame 1 on. Valid as long.
  /// Throws InputError when only boxes are known.
  virtual std::span<const Pose> poses() = 0;
};

}  // namespace broadmark
