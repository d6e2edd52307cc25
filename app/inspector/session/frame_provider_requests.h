// What asks the run thread to open something: a recording, an import, a simulation, which the user
// may adjust first.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include "broadmark/harness/case_result.h"
#include "broadmark/parameters.h"
#include "broadmark/scenes/simulation.h"
#include "inspector/session/playback.h"

namespace broadmark {

// `swept`: shown as swept boxes.

/// The simulation with its present parameters.
FrameProviderRequest simulationSource(Simulation& simulation, bool swept);
/// `hash`: the expected one; "": any. Throws InputError.
FrameProviderRequest recordingSource(const std::filesystem::path& path, const std::string& hash,
                                     bool swept);
/// Throws InputError.
FrameProviderRequest importSource(const RecordingReference& reference, bool swept);

/// The parameters of the request's scene, "scene" among them, as far as they are known. Null: none.
ParameterValues sceneParametersOf(const FrameProviderRequest* source);

/// The built-in scene that the user adjusts, and starts.
class Draft {
 public:
  /// `playback` outlives it.
  explicit Draft(Playback& playback) : playback_(playback) {}

  [[nodiscard]] Simulation& scene() const { return *scene_; }
  /// Replaces it by another built-in scene, with the parameters that both have in common.
  void choose(const std::string& id);
  void take(std::unique_ptr<Simulation> scene) { scene_ = std::move(scene); }

  /// Shows a live simulation with the present parameters.
  void simulate() { playback_.show(simulationSource(*scene_, playback_.swept)); }
  /// Whether what is open is its simulation, or was baked with its parameters.
  [[nodiscard]] bool isOpen() const;

 private:
  Playback& playback_;
  std::unique_ptr<Simulation> scene_ = makeSimulation("freefall");
};

}  // namespace broadmark
