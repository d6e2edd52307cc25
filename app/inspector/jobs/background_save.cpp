#include "inspector/jobs/background_save.h"

#include <utility>

#include "broadmark/recordings/recording.h"

namespace broadmark {

JobStatus SaveReport::status() const {
  const bool done = state == TaskState::done;
  return {.activity = "A recording is being saved.",
          .outcome = done ? "recorded: " + file.string() : "",
          .file = done ? file : "",
          .values = {{"file", file.string()}}};
}

void startSave(BackgroundSave& job, std::unique_ptr<FrameSource> source,
               std::filesystem::path file) {
  const SceneInfo scene = source->scene();
  auto writer = std::make_unique<RecordingWriter>(file, scene);
  SaveReport initial;
  initial.file = std::move(file);
  job.start(std::move(initial), [&job, source = std::move(source), writer = std::move(writer),
                                 sets = scene.frames + 1] {
    const bool complete = recordAll(*source, *writer, [&](std::uint32_t frame) {
      job.update([&](SaveReport& report) {
        report.fraction = static_cast<float>(frame + 1) / static_cast<float>(sets);
      });
      return !job.cancelled();
    });
    if (complete) writer->finish();
    return complete;
  });
}

}  // namespace broadmark
