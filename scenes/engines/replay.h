// Engines without simulation: their frames come from a recording.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "broadmark/recordings/recording.h"
#include "broadmark/scenes/simulation.h"

namespace broadmark::scenes {

/// Replays the frames of a recording; derived classes may transform them.
class Replay : public FrameSource, public PoseSource {
 public:
  explicit Replay(std::unique_ptr<Recording> recording) : recording_(std::move(recording)) {}

  [[nodiscard]] const SceneInfo& scene() const override { return recording_->scene(); }
  Frame rewind() override { return recording_->rewind(); }
  std::optional<Frame> next() override { return recording_->next(); }
  std::span<const Aabb> unrotatedBoxes() override { return posed().unrotatedBoxes(); }
  std::span<const Pose> poses() override { return posed().poses(); }

  std::string inputHash() { return recording_->hash(); }

 protected:
  Recording& recording() { return *recording_; }

 private:
  [[nodiscard]] PoseSource& posed() const;

  std::unique_ptr<Recording> recording_;
};

struct ReplayEntry {
  EngineListing listing;
  /// Bodies made from each recorded body.
  std::uint32_t bodies_per_recorded;
  /// Extensions of readable recordings, the preferred one first.
  std::vector<std::string_view> extensions;
  /// Creates the replay of a recording with one of these extensions.
  std::unique_ptr<Replay> (*create)(std::unique_ptr<Recording>);
};

std::vector<ReplayEntry> replayEntries();

namespace splitter {
ReplayEntry entry();
}

/// A replay of a built-in scene: a simulation with parameters that select the recording.
/// `required_extension`: the extension of recordings that can hold the scene.
std::unique_ptr<Simulation> makeReplay(const SceneListing& scene, const ReplayEntry& engine,
                                       std::string_view required_extension);

}  // namespace broadmark::scenes
