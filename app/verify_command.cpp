// broadmark verify: reads recordings through and says what is wrong with them.

#include <fmt/format.h>

#include "app/interrupt.h"
#include "app/options.h"
#include "app/progress.h"
#include "broadmark/error.h"
#include "broadmark/recording.h"

namespace broadmark {
namespace {

/// Reads every frame. Throws InputError at the first fault.
void verify(const std::filesystem::path& file) {
  const auto recording = openRecordingFile(file);
  const SceneInfo& scene = recording->scene();
  Progress progress("verifying " + file.string(), scene.frames, scene.frames < 100);
  recording->rewind();
  while (const auto frame = recording->next()) progress.update(frame->index);
  fmt::print("{}: ok: {} {}, {} bodies, {} frames, hash {}\n", file.string(), scene.name,
             scene.object_type, scene.objects, scene.frames, recording->hash());
}

}  // namespace

int runVerify(const std::vector<std::filesystem::path>& files) {
  int status = 0;
  for (const auto& file : files) {
    try {
      verify(file);
    } catch (const InputError& error) {
      fmt::print(stderr, "broadmark: {}\n", error.what());
      status = 2;
    }
  }
  return status;
}

}  // namespace broadmark
