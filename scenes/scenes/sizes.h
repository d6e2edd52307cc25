// Bodies of all sizes.
#pragma once

#include "broadmark/scenes/random.h"
#include "broadmark/scenes/shape.h"

namespace broadmark::scenes {

/// A random size from 1 to `most` (at least 1). Of bodies twice as large there are an eighth as
/// many: large and small ones fill about the same room.
double sizeOfMany(double most, Random&);

/// A random place at which a body is inside a world of this side, however it is turned.
Vec3 anywhereInside(const Shape&, double side, Random&);

}  // namespace broadmark::scenes
