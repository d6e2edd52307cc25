// Off-screen pictures of a run's recordings.

#include "run/screenshot.h"

#include <fmt/format.h>

#include <algorithm>

namespace broadmark {

void takeScreenshot(IndexedFrames& recording, std::uint32_t index, Oracle& oracle,
                    const PictureOptions& options, const std::filesystem::path& path) {
  const Frame frame = recording.at(index);
  const PairRun pairs = oracle.pairs(frame.boxes, recording.scene().filter);
  const auto context = makeOffscreenContext(options.gl);
  writePng(path, drawFrame(*context, recording.scene(), frame, {&pairs, 1}, options.width,
                           options.height));
}

std::vector<std::filesystem::path> screenshotPaths(const std::filesystem::path& asked,
                                                   const std::vector<std::string>& recordings) {
  if (recordings.size() == 1) return {asked};
  std::vector<std::filesystem::path> paths;
  for (const std::string& recording : recordings) {
    const std::string name = fmt::format("{} {}", asked.stem().string(), recording);
    std::filesystem::path path = asked;
    path.replace_filename(name + asked.extension().string());
    // Two recordings may differ in nothing but their boxes.
    for (int k = 2; std::ranges::find(paths, path) != paths.end(); ++k) {
      path.replace_filename(fmt::format("{} ({}){}", name, k, asked.extension().string()));
    }
    paths.push_back(path);
  }
  return paths;
}

}  // namespace broadmark
