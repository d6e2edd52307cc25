// Pictures of a run's recordings.
#pragma once

#include <filesystem>

#include "broadmark/harness/oracle.h"
#include "broadmark/recordings/recording.h"
#include "request/run_request.h"

namespace broadmark {

/// Draws frame `index` off-screen into `path`, with the pairs that the oracle finds. Throws
/// RenderError (no OpenGL) or InputError (frame, path).
void takeScreenshot(IndexedFrames&, std::uint32_t index, Oracle&, const PictureOptions&,
                    const std::filesystem::path& path);

}  // namespace broadmark
