// What all simulations by a physics engine share: built-in and authored scenes.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "broadmark/scenes/authored_scene.h"
#include "broadmark/scenes/bodies.h"
#include "broadmark/scenes/physics_engine.h"
#include "broadmark/scenes/simulation.h"

namespace broadmark::scenes {

/// Keeps the parameters of the physics engine that is chosen, and forgets them when another one is.
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

/// Drives a physics engine, frame by frame, within six walls. A body whose centre leaves the world
/// is frozen.
class PhysicsSimulation : public Simulation, public SceneSource {
 public:
  using Simulation::Simulation;

  [[nodiscard]] const SceneInfo& scene() const override;
  Frame rewind() override;
  std::optional<Frame> next() override;
  std::span<const Aabb> unturnedBoxes() override;
  std::span<const Pose> poses() override { return bodies_->poses(); }
  [[nodiscard]] AuthoredScene authoredScene() override;

 protected:
  /// The scene that the present parameters describe.
  [[nodiscard]] virtual SceneInfo describe() const = 0;
  [[nodiscard]] virtual std::unique_ptr<PhysicsEngine> createEngine() = 0;
  /// Which layers push each other.
  [[nodiscard]] virtual LayerMatrix pushing(const SceneInfo&) const = 0;
  /// Adds the bodies of the initial pose to the engine, which has only walls yet, and sets the
  /// forces.
  virtual void start() = 0;
  /// Called before frame `frame`, 1 or later, is recorded: bodies come and go.
  virtual void comeAndGo(std::uint32_t /*frame*/) {}
  /// Called after frame `frame`, 1 or later, when the next one is asked for.
  virtual void act(std::uint32_t /*frame*/) {}

  // Both only once the first frame is asked for.
  [[nodiscard]] PhysicsEngine& engine() { return *engine_; }
  [[nodiscard]] Bodies& bodies() { return *bodies_; }

 private:
  void makeEngine();
  void addWalls();
  void freezeEscapees();

  mutable SceneInfo info_;
  std::unique_ptr<PhysicsEngine> engine_;
  std::optional<Bodies> bodies_;
  std::vector<Aabb> unturned_;
  std::uint32_t index_ = 0;
};

}  // namespace broadmark::scenes
