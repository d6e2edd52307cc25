// Recorders write the frames of a simulation. One implementation per file, listed in
// CMakeLists.txt.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "broadmark/frame.h"
#include "broadmark/pose.h"
#include "broadmark/recordings/recording.h"
#include "broadmark/scenes/simulation.h"

namespace broadmark::scenes {

/// Writes one recording. Leaves no file unless finish() is called.
class Recorder {
 public:
  virtual ~Recorder() = default;

  /// Writes the frame that `poses` has just handed out. The initial pose comes first.
  virtual void record(const Frame& frame, PoseSource& poses) = 0;
  /// Makes the recording whole. Returns its hash.
  virtual std::string finish() = 0;
};

struct RecorderEntry {
  RecorderListing listing;
  std::unique_ptr<Recorder> (*create)(const std::filesystem::path&, const SceneInfo&,
                                      const RecordingOrigin&);
};

/// All of them, in the order of the list in CMakeLists.txt.
std::vector<RecorderEntry> recorderEntries();

}  // namespace broadmark::scenes
