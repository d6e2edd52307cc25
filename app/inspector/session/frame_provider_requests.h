// Requests to the run thread to open a recording, an import or a simulation, and the draft of a
// simulation.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include "broadmark/harness/case_result.h"
#include "broadmark/parameters.h"
#include "broadmark/scenes/simulation.h"
#include "inspector/session/playback.h"
#include "sources/source.h"

namespace broadmark {

// `reading`: options that change the boxes (adapted_frames.h).

/// Requests a simulation with the current parameters.
FrameProviderRequest simulationSource(Simulation& simulation, ParameterValues reading);
/// `hash`: expected hash; "": any. Throws InputError.
FrameProviderRequest recordingSource(const std::filesystem::path& path, const std::string& hash,
                                     ParameterValues reading);
/// Takes the frames of an imported source.
FrameProviderRequest importSource(Source& source, ParameterValues reading);

/// Returns the known parameters of the request's scene, including "scene"; none for null.
ParameterValues sceneParametersOf(const FrameProviderRequest* source);

/// The built-in scene whose parameters the user edits before starting it.
class Draft {
 public:
  /// `playback` must outlive this object.
  explicit Draft(Playback& playback) : playback_(playback) {}

  [[nodiscard]] Simulation& scene() const { return *scene_; }
  /// Replaces the scene by another built-in one, keeping the parameters that both have.
  void choose(const std::string& id);
  void adopt(std::unique_ptr<Simulation> scene) { scene_ = std::move(scene); }

  /// Shows a live simulation with the current parameters.
  void simulate() { playback_.show(simulationSource(*scene_, playback_.reading)); }
  /// Whether the open source is this simulation, or was baked with these parameters.
  [[nodiscard]] bool isOpen() const;

 private:
  Playback& playback_;
  std::unique_ptr<Simulation> scene_ = makeSimulation("freefall");
};

}  // namespace broadmark
