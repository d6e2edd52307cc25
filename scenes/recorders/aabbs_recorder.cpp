// Boxes, as .aabbs: what algorithms are run on.

#include "broadmark/recording.h"
#include "recorders/recorder.h"

namespace broadmark::scenes::aabbs_recorder {
namespace {

class AabbsRecorder final : public Recorder {
 public:
  AabbsRecorder(const std::filesystem::path& path, const SceneInfo& scene) : writer_(path, scene) {}

  void record(const Frame& frame, PoseSource&) override { writer_.write(frame.boxes); }
  std::string finish() override { return writer_.finish(); }

 private:
  RecordingWriter writer_;
};

}  // namespace

RecorderEntry entry() {
  return {.listing = {"aabbs", "boxes of all bodies, frame after frame", "Recordings_AABBs"},
          .create = [](const std::filesystem::path& path,
                       const SceneInfo& scene) -> std::unique_ptr<Recorder> {
            return std::make_unique<AabbsRecorder>(path, scene);
          }};
}

}  // namespace broadmark::scenes::aabbs_recorder
