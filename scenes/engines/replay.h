// Engines that simulate nothing: they make their frames from a recording. One implementation per
// file, listed in CMakeLists.txt.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "broadmark/recordings/recording.h"
#include "broadmark/scenes/simulation.h"

namespace broadmark::scenes {

/// The frames made from one recording.
class Replay : public FrameSource, public PoseSource {
 public:
  /// The recording's.
  virtual std::string inputHash() = 0;
};

struct ReplayEntry {
  EngineListing listing;
  /// Bodies made from each recorded body.
  std::uint32_t bodies_per_recorded;
  /// Extensions of the recordings that it reads, the preferred one first.
  std::vector<std::string_view> extensions;
  /// The recording has one of these extensions.
  std::unique_ptr<Replay> (*create)(std::unique_ptr<Recording>);
};

/// All of them, in the order of the list in CMakeLists.txt.
std::vector<ReplayEntry> replayEntries();

/// A replay of a built-in scene: a simulation whose parameters say which recording it reads.
/// `needed`: the extension of recordings that can hold the scene.
std::unique_ptr<Simulation> makeReplay(const SceneListing& scene, const ReplayEntry& engine,
                                       std::string_view needed);

}  // namespace broadmark::scenes
