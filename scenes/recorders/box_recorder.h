// Recorders of boxes, whatever the kind of recording.
#pragma once

#include <string>

#include "broadmark/recordings/recording.h"
#include "recorders/recorder.h"

namespace broadmark::scenes {

class BoxRecorder final : public Recorder {
 public:
  BoxRecorder(const std::filesystem::path& path, const SceneInfo& scene,
              const RecordingOrigin& origin)
      : writer_(path, scene, origin) {}

  void record(const Frame& frame, PoseSource&) override { writer_.write(frame); }
  std::string finish() override { return writer_.finish(); }

 private:
  RecordingWriter writer_;
};

}  // namespace broadmark::scenes
