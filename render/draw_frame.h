// drawFrame() with the arguments that tests vary.
#pragma once

#include <cstddef>
#include <limits>

#include "broadmark/debug_draw.h"
#include "broadmark/render/picture.h"

namespace broadmark {

inline constexpr int kLargestPicture = 16384;  ///< pixels, either side

// The colours of a picture: warm and strong for what overlaps, cool and quiet for the rest.
inline constexpr Rgb kFreeBox = 0xC3D0DE;
inline constexpr Rgb kOverlappingBox = 0xFA6E1E;

/// Like the public drawFrame(), with at most `max_batch` boxes per draw call.
Picture drawFrame(OffscreenContext& context, const SceneInfo& scene, const Frame& frame,
                  PairRuns overlaps, int width, int height, std::size_t max_batch);

}  // namespace broadmark
