// Random access to the frames of a scene, from any kind of source.
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
#include "request/simulation_process.h"

namespace broadmark {

/// Opens the frames up to at least `last`, which must be available. Throws InputError.
using FrameOpener = std::function<std::unique_ptr<IndexedFrames>(std::uint32_t last)>;

/// A recording, or a live simulation or import that is run on demand: its frames are written to an
/// unnamed temporary file for random access. Either can be shown with adapted boxes
/// (adapted_frames.h), as `reading` says. Not thread-safe.
class FrameProvider {
 public:
  explicit FrameProvider(std::unique_ptr<Recording> recording, ParameterValues reading = {});
  /// Starts the simulation with its current parameters.
  explicit FrameProvider(std::unique_ptr<FrameSource> simulation, ParameterValues reading = {});
  /// A scene of a single frame; `scene.frames` is 0.
  FrameProvider(SceneInfo scene, std::span<const Aabb> boxes);
  ~FrameProvider();

  /// `scene().frames` counts all frames, including those not simulated yet.
  [[nodiscard]] const SceneInfo& scene() const { return frames_->scene(); }
  /// The last frame that is already available.
  [[nodiscard]] std::uint32_t lastAvailable() const { return available_; }
  /// Whether frames beyond lastAvailable() have to be simulated first.
  [[nodiscard]] bool live() const { return simulation_ != nullptr; }

  /// Simulates the next frame, which must exist.
  void simulateNext();
  /// Returns an available frame; valid until the next call. Throws InputError for a broken
  /// recording.
  Frame at(std::uint32_t index) { return frames_->at(index); }

  /// Converts an available frame, the latest of a live simulation, to an authored scene, with the
  /// bodies' properties if the source provides them. Throws InputError for invalid boxes.
  [[nodiscard]] scenes::AuthoredScene authoredScene(std::uint32_t index);

  /// Returns an opener that any thread may call, even after this object is destroyed.
  [[nodiscard]] FrameOpener opener() const;

 private:
  struct Written;
  class TemporaryFrames;

  /// Starts the temporary file with the first frame.
  void store(const SceneInfo& scene, const Frame& first);

  ParameterValues reading_;
  std::uint32_t available_ = 0;
  std::unique_ptr<IndexedFrames> frames_;
  std::unique_ptr<FrameSource> simulation_;
  std::shared_ptr<Written> written_;  ///< read by frames_; null for a recording
};

/// Opens a source; each call returns a new provider, with its simulation in the host. Throws
/// InputError, and Cancelled soon after `cancelled` returns true, as does a simulation's next
/// frame.
using FrameProviderOpener = std::function<std::unique_ptr<FrameProvider>(
    const SimulationHost& host, const CancelQuery& cancelled)>;

}  // namespace broadmark
