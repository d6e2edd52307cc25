// Off-screen pictures of a run's recordings.

#include "app/screenshot.h"

#include <fmt/format.h>

#include "render/picture.h"

namespace broadmark {

void takeScreenshot(const HeadlessOptions& options, RecordingReader& recording, Oracle& oracle,
                    const std::filesystem::path& path) {
  const SceneInfo& scene = recording.scene();
  const Frame frame =
      recording.read(options.screenshot_frame == 0 ? scene.frames : options.screenshot_frame);
  const PairRun pairs = oracle.pairs(frame);
  const auto context = makeOffscreenContext(options.gl);
  writePng(path, drawFrame(*context, scene, frame, {&pairs, 1}, options.screenshot_width,
                           options.screenshot_height));
}

std::filesystem::path screenshotPath(const std::filesystem::path& asked, const SceneInfo& scene,
                                     bool several) {
  if (!several) return asked;
  std::filesystem::path path = asked;
  return path.replace_filename(fmt::format("{} {} {} N{}{}", asked.stem().string(), scene.name,
                                           scene.object_type, scene.objects,
                                           asked.extension().string()));
}

}  // namespace broadmark
