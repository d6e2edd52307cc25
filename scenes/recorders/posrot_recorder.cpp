// Positions and rotations, as .posrot: what the engines viewer and splitter replay.

#include "broadmark/recordings/posrot.h"
#include "entries.h"
#include "recorders/recorder.h"

namespace broadmark::scenes::posrot_recorder {
namespace {

class PosrotRecorder final : public Recorder {
 public:
  PosrotRecorder(const std::filesystem::path& path, const SceneInfo& scene, const RecordingOrigin&)
      : writer_(path, scene) {}

  void record(const Frame& frame, PoseSource& poses) override {
    if (frame.index == 0) {
      writer_.writeBoxes(poses.unturnedBoxes());
    } else {
      writer_.write(poses.poses());
    }
  }
  std::string finish() override { return writer_.finish(); }

 private:
  PosrotWriter writer_;
};

}  // namespace

RecorderEntry entry() {
  return {{"posrot", "positions and rotations of all bodies, frame after frame",
           "Recordings_PositionRotation"},
          makeAs<Recorder, PosrotRecorder>};
}

}  // namespace broadmark::scenes::posrot_recorder
