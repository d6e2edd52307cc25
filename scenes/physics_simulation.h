// What all simulations by a physics engine share, whoever says which bodies there are.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "broadmark/scenes/authored_scene.h"
#include "broadmark/scenes/registry.h"
#include "broadmark/scenes/simulation.h"

namespace broadmark::scenes {

/// The parameters of the engine that is chosen. Those of another one are forgotten.
class ChosenEngine {
 public:
  /// What has them, and no bodies.
  Parametrised& parameters(const Choice& choice, const PhysicsSettings& settings);
  /// A new engine with these parameters.
  std::unique_ptr<PhysicsEngine> create(const Choice& choice, const PhysicsSettings& settings);

 private:
  std::string id_;
  std::unique_ptr<PhysicsEngine> engine_;
};

/// Drives a physics engine, frame by frame, inside of six walls. A body whose centre gets out of
/// the world is held where it is.
class PhysicsSimulation : public Simulation, public SceneSource {
 public:
  using Simulation::Simulation;

  [[nodiscard]] const SceneInfo& scene() const override;
  Frame rewind() override;
  std::optional<Frame> next() override;
  std::span<const Aabb> unturnedBoxes() override;
  std::span<const Pose> poses() override { return poses_; }
  [[nodiscard]] AuthoredScene authoredScene() override;

 protected:
  /// What the parameters describe at present.
  [[nodiscard]] virtual SceneInfo describe() const = 0;
  [[nodiscard]] virtual std::unique_ptr<PhysicsEngine> createEngine() = 0;
  /// Adds all bodies to an engine that has walls only, and says which forces act.
  virtual void start() = 0;
  /// Called after frame `frame` has been recorded.
  virtual void act(std::uint32_t /*frame*/) {}

  PhysicsBody& addBody(const BodyDescription&);
  /// The running engine; null before the first frame.
  [[nodiscard]] PhysicsEngine* engine() const { return engine_.get(); }
  [[nodiscard]] std::span<PhysicsBody* const> bodies() const { return bodies_; }

 private:
  void addWalls();
  void freezeEscapees();
  Frame record();

  mutable SceneInfo info_;
  std::unique_ptr<PhysicsEngine> engine_;
  std::vector<PhysicsBody*> bodies_;
  std::vector<double> masses_;
  std::vector<Aabb> boxes_;
  std::vector<Aabb> unturned_;
  std::vector<Pose> poses_;
  std::uint32_t index_ = 0;
};

}  // namespace broadmark::scenes
