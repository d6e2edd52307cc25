// drawFrame() with the arguments that tests vary.
#pragma once

#include <cstddef>

#include "broadmark/render/picture.h"

namespace broadmark {

inline constexpr int kLargestPicture = 16384;  ///< pixels, either side

/// Like the public drawFrame(), with at most `max_batch` boxes per draw call.
Picture drawFrame(OffscreenContext& context, const SceneInfo& scene, const Frame& frame,
                  PairRuns overlaps, int width, int height, std::size_t max_batch);

}  // namespace broadmark
