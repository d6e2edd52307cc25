// Pictures of a run's recordings.
#pragma once

#include <filesystem>
#include <vector>

#include "broadmark/harness/oracle.h"
#include "broadmark/recordings/recording.h"
#include "request/run_request.h"

namespace broadmark {

/// Draws frame `index` off-screen into `path`, with the pairs that the oracle finds. Throws
/// RenderError (no OpenGL) or InputError (frame, path).
void takeScreenshot(IndexedFrames&, std::uint32_t index, Oracle&, const PictureOptions&,
                    const std::filesystem::path& path);

/// A path for each recording of a run: the file asked for, or, when there are several recordings,
/// that name followed by the recording's.
std::vector<std::filesystem::path> screenshotPaths(const std::filesystem::path& asked,
                                                   const std::vector<std::string>& recordings);

}  // namespace broadmark
