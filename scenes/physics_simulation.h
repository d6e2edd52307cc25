// What all simulations by a physics engine share: built-in and authored scenes.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "broadmark/scenes/authored_scene.h"
#include "broadmark/scenes/physics_engine.h"
#include "broadmark/scenes/simulation.h"

namespace broadmark::scenes {

/// Drives a physics engine, frame by frame, within six walls. A body whose centre leaves the world
/// is frozen.
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
  /// The scene that the present parameters describe.
  [[nodiscard]] virtual SceneInfo describe() const = 0;
  [[nodiscard]] virtual std::unique_ptr<PhysicsEngine> createEngine() = 0;
  /// Adds all bodies to the engine, which has only walls yet, and sets the forces.
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
