// The small cross of axes in the lower left corner of a picture.
#pragma once

#include <vector>

#include "broadmark/render/camera.h"
#include "broadmark/render/palette.h"
#include "primitive_renderer.h"

namespace broadmark {

inline constexpr float kAxesMargin = 8;  ///< pixels, before scaling

/// A square picture that shows the unit axes from the direction of `viewpoint`'s camera.
Viewpoint axesViewpoint(const Viewpoint& viewpoint, float scale);

/// The axes as lines, from the farthest to the nearest.
std::vector<Primitive> axesCross(const Camera& camera, const Palette& theme, float scale);

}  // namespace broadmark
