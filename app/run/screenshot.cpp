// Off-screen pictures of a run's recordings.

#include "run/screenshot.h"

namespace broadmark {

void takeScreenshot(IndexedFrames& recording, std::uint32_t index, Oracle& oracle,
                    const PictureOptions& options, const std::filesystem::path& path) {
  const Frame frame = recording.at(index);
  const PairRun pairs = oracle.pairs(frame.boxes, recording.scene().filter);
  const auto context = makeOffscreenContext(options.gl);
  writePng(path, drawFrame(*context, recording.scene(), frame, {&pairs, 1}, options.width,
                           options.height));
}

}  // namespace broadmark
