// The rotating force of the Gravity scene.
#pragma once

#include "broadmark/scenes/shape.h"

namespace broadmark::scenes {

/// A direction that rotates about an axis that rotates, too: over time it points everywhere.
struct TurningDirection {
  Vec3 direction{1, 0, 0};
  Vec3 axis{0, 1, 0};
};

/// After one turn: the axis turns by `angle` (radians) about +z, then the direction turns by
/// `angle` about the new axis.
TurningDirection turned(const TurningDirection&, double angle);

}  // namespace broadmark::scenes
