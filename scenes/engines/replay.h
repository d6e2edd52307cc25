// Engines that simulate nothing: their frames are made from a recording. One implementation per
// file, listed in CMakeLists.txt.
#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "broadmark/recording.h"
#include "broadmark/scenes/simulation.h"

namespace broadmark::scenes {

/// The frames made from one recording, all of them.
class Replay : public FrameSource, public PoseSource {};

struct ReplayEntry {
  EngineListing listing;
  /// How many bodies each recorded one becomes.
  std::uint32_t bodies_per_recorded;
  /// What it can read, the best first.
  std::vector<std::string_view> extensions;
  /// The recording is of one of these kinds.
  std::unique_ptr<Replay> (*create)(std::unique_ptr<Recording>);
};

/// All of them, in the order of the list in CMakeLists.txt.
std::vector<ReplayEntry> replayEntries();

/// A replay of a built-in scene: a simulation whose parameters say which recording is meant.
std::unique_ptr<Simulation> makeReplay(const SceneListing& scene, const ReplayEntry& engine);

}  // namespace broadmark::scenes
