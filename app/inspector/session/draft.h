// The built-in scene that the user adjusts, and starts.
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "broadmark/scenes/simulation.h"
#include "inspector/session/footage_requests.h"
#include "inspector/session/playback.h"

namespace broadmark {

class Draft {
 public:
  /// `playback` outlives it.
  explicit Draft(Playback& playback) : playback_(playback) {}

  [[nodiscard]] Simulation& scene() { return *scene_; }
  [[nodiscard]] const Simulation& scene() const { return *scene_; }
  /// Replaces it by another built-in scene, with the parameters that both have in common.
  void choose(const std::string& id, const std::string& engine = {});
  void take(std::unique_ptr<Simulation> scene) { scene_ = std::move(scene); }

  /// Shows a live simulation with the present parameters.
  void simulate() { playback_.show(simulationFootage(*scene_, playback_.swept)); }
  /// Whether what is open is its simulation, or was baked with its parameters.
  [[nodiscard]] bool isOpen() const;

 private:
  Playback& playback_;
  std::unique_ptr<Simulation> scene_ = makeSimulation("freefall");
};

}  // namespace broadmark
