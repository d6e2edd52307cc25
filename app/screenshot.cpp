// Off-screen pictures of a run's recordings.

#include "screenshot.h"

#include <fmt/format.h>

#include <algorithm>

#include "broadmark/render/picture.h"

namespace broadmark {

void takeScreenshot(const HeadlessOptions& options, Recording& recording, Oracle& oracle,
                    const std::filesystem::path& path) {
  const SceneInfo& scene = recording.scene();
  const Frame frame = recording.read(options.screenshot_frame.value_or(scene.frames));
  const PairRun pairs = oracle.pairs(frame);
  const auto context = makeOffscreenContext(options.gl);
  writePng(path, drawFrame(*context, scene, frame, {&pairs, 1}, options.screenshot_width,
                           options.screenshot_height));
}

std::vector<std::filesystem::path> screenshotPaths(const std::filesystem::path& asked,
                                                   const std::vector<const SceneInfo*>& scenes) {
  if (scenes.size() == 1) return {asked};
  std::vector<std::filesystem::path> paths;
  for (const SceneInfo* scene : scenes) {
    const std::string name = fmt::format("{} {} {} N{}", asked.stem().string(), scene->name,
                                         scene->object_type, scene->objects);
    std::filesystem::path path = asked;
    path.replace_filename(name + asked.extension().string());
    // Recordings may differ in nothing but their contents.
    for (int k = 2; std::ranges::find(paths, path) != paths.end(); ++k) {
      path.replace_filename(fmt::format("{} ({}){}", name, k, asked.extension().string()));
    }
    paths.push_back(path);
  }
  return paths;
}

}  // namespace broadmark
