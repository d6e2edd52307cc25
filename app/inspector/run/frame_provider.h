// The frames of a scene by number, wherever they come from.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>

#include "broadmark/files.h"
#include "broadmark/frame.h"
#include "broadmark/recordings/recording.h"
#include "broadmark/scenes/authored_scene.h"
#include "broadmark/scenes/simulation.h"

namespace broadmark {

/// Opens the frames up to `last`, which exist already, and perhaps more. Throws InputError.
using FrameOpener = std::function<std::unique_ptr<IndexedFrames>(std::uint32_t last)>;

/// A recording, or a live simulation or import that goes only as far as it is watched: its frames
/// are kept in an unnamed temporary file, so that any of them can be seen again. Either can be
/// shown as swept boxes. To be used from one thread.
class FrameProvider {
 public:
  explicit FrameProvider(std::unique_ptr<Recording> recording, bool swept = false);
  /// The simulation begins with its present parameters.
  explicit FrameProvider(std::unique_ptr<FrameSource> simulation, bool swept = false);
  /// A scene of a single frame; `scene.frames` is 0.
  FrameProvider(SceneInfo scene, std::span<const Aabb> boxes);

  /// Its `frames` counts all there may ever be.
  [[nodiscard]] const SceneInfo& scene() const { return frames_->scene(); }
  /// The last frame that exists already.
  [[nodiscard]] std::uint32_t known() const { return known_; }
  /// Whether frames beyond known() would have to be simulated first.
  [[nodiscard]] bool live() const { return simulation_ != nullptr; }

  /// Simulates the next frame. There must be one.
  void extend();
  /// A known frame; valid until the next call. Throws InputError (a broken recording).
  Frame at(std::uint32_t index) { return frames_->at(index); }

  /// A known frame as a scene of its own, with all that is known of its bodies. Of a live
  /// simulation it has to be the latest. Throws InputError when it holds what no body can be.
  [[nodiscard]] scenes::AuthoredScene authoredScene(std::uint32_t index);

  /// Opens the frames, for use from any thread, also when this is gone.
  [[nodiscard]] FrameOpener opener() const;

 private:
  void keep(const SceneInfo& scene, std::span<const Aabb> first);
  bool swept_ = false;
  std::uint32_t known_ = 0;
  std::unique_ptr<IndexedFrames> frames_;
  std::unique_ptr<FrameSource> simulation_;
  std::shared_ptr<const FileDescriptor> kept_;  ///< what frames_ reads; null for a recording
};

/// Opens a source; each call returns a new provider. Throws InputError.
using FrameProviderOpener = std::function<std::unique_ptr<FrameProvider>()>;

}  // namespace broadmark
