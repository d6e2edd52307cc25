// Shared base of simulations with a physics engine: built-in and authored scenes.
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

/// Retains the parameters of the chosen physics engine until another is chosen.
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

/// Drives a physics engine, frame by frame, within six walls. Freezes bodies with their centre
/// outside the world.
class PhysicsSimulation : public Simulation, public SceneSource {
 public:
  using Simulation::Simulation;

  [[nodiscard]] const SceneInfo& scene() const override;
  Frame rewind() override;
  std::optional<Frame> next() override;
  std::span<const Aabb> unrotatedBoxes() override;
  std::span<const Pose> poses() override { return bodies_->poses(); }
  [[nodiscard]] AuthoredScene authoredScene() override;
  [[nodiscard]] std::span<const Escape> escapes() const override { return escapes_; }

 protected:
  /// The scene for the current parameters.
  [[nodiscard]] virtual SceneInfo describe() const = 0;
  [[nodiscard]] virtual std::unique_ptr<PhysicsEngine> createEngine() = 0;
  /// The layers that push each other.
  [[nodiscard]] virtual LayerMatrix pushing(const SceneInfo&) const = 0;
  /// Adds the bodies of the initial pose to the engine, which has only walls yet, and sets the
  /// forces.
  virtual void start() = 0;
  /// Called before frame `frame`, 1 or later, is recorded: adds and removes bodies.
  virtual void updatePresence(std::uint32_t /*frame*/) {}
  /// Called after frame `frame`, 1 or later, when the next one is requested.
  virtual void act(std::uint32_t /*frame*/) {}

  // Valid once the first frame has been requested.
  [[nodiscard]] PhysicsEngine& engine() { return *engine_; }
  [[nodiscard]] Bodies& bodies() { return *bodies_; }

 private:
  /// Returns call(), which advances to frame `frame` with the engine. An exception of a plug-in's
  /// engine becomes an InputError that names it.
  template <class Call>
  auto guarded(std::uint32_t frame, const Call& call);
  Frame restart();
  Frame advance();
  void makeEngine();
  void addWalls();
  void freezeEscapees();

  mutable SceneInfo info_;
  std::unique_ptr<PhysicsEngine> engine_;
  std::string plugin_engine_;  ///< the engine with its plug-in, for messages; "": built in
  std::optional<Bodies> bodies_;
  std::vector<Aabb> unrotated_;
  std::vector<Escape> escapes_;
  std::uint32_t index_ = 0;
};

}  // namespace broadmark::scenes
