// The screenshot of a headless run.
#pragma once

#include <filesystem>
#include <vector>

#include "options.h"
#include "broadmark/oracle.h"
#include "broadmark/recording.h"

namespace broadmark {

/// Draws the chosen frame of a recording off-screen, the pairs being the oracle's, into `path`.
/// Throws RenderError (no OpenGL) or InputError (no such frame, path).
void takeScreenshot(const HeadlessOptions&, Recording&, Oracle&, const std::filesystem::path& path);

/// Where the screenshots of all recordings of a run go: the file asked for, or, when there are
/// several recordings, that name followed by the recording's.
std::vector<std::filesystem::path> screenshotPaths(const std::filesystem::path& asked,
                                                   const std::vector<const SceneInfo*>& scenes);

}  // namespace broadmark
