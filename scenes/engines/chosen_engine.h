// The physics engine that a simulation's parameters choose, with its own parameters.
#pragma once

#include <memory>
#include <string>

#include "broadmark/scenes/physics_engine.h"

namespace broadmark::scenes {

/// Keeps the parameters of the chosen engine, and forgets them when another one is chosen.
class ChosenEngine {
 public:
  /// The parameters of the engine `id`: an engine without bodies.
  Parametrised& parameters(const std::string& id, const PhysicsSettings& settings);
  /// A new engine with these parameters.
  std::unique_ptr<PhysicsEngine> create(const std::string& id, const PhysicsSettings& settings);

 private:
  std::string id_;
  std::unique_ptr<PhysicsEngine> engine_;
};

}  // namespace broadmark::scenes
