// Boxes, as .aabbs: what algorithms are run on.

#include "broadmark/recording.h"
#include "entries.h"
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
  return {{"aabbs", "boxes of all bodies, frame after frame", "Recordings_AABBs"},
          makeAs<Recorder, AabbsRecorder>};
}

}  // namespace broadmark::scenes::aabbs_recorder
