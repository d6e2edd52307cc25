// Glass: the bodies that are drawn transparent, because they hide the bodies in focus.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "broadmark/aabb.h"
#include "inspector/authoring/gizmo.h"

namespace broadmark {

/// Flags the bodies between the eye and the bodies in focus, those close to them, and those close
/// to the eye, which the near plane would cut. More than two bodies in focus count as one. Empty if
/// none of them is present. O(boxes).
std::vector<std::uint8_t> glassBefore(std::span<const Aabb> boxes,
                                      std::span<const std::uint32_t> focus, const Point& eye);

}  // namespace broadmark
