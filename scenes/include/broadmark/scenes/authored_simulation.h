// Simulation of authored scenes, and conversion of frames to authored scenes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "broadmark/scenes/authored_scene.h"
#include "broadmark/scenes/physics_engine.h"
#include "broadmark/scenes/simulation.h"

namespace broadmark::scenes {

class ChosenEngine;

/// The typed parameters of an authored scene: frames, engine, gravity, physics, and the chosen
/// engine's.
class AuthoredParameters final : public Parametrised {
 public:
  /// The defaults, overridden by the stated values. Throws InputError for an unknown parameter or
  /// an invalid value.
  explicit AuthoredParameters(const ParameterValues& stated = {});
  /// Copies the values of another scene for all common parameters.
  AuthoredParameters(const ParameterValues& other, const Vec3& gravity);
  ~AuthoredParameters() override;
  AuthoredParameters(AuthoredParameters&&) noexcept;
  AuthoredParameters& operator=(AuthoredParameters&&) noexcept;

  void visitParameters(const ParameterVisitor&) override;
  [[nodiscard]] ParameterValues values() { return parameterValues(*this); }

  [[nodiscard]] std::uint32_t frames() const { return static_cast<std::uint32_t>(frames_); }
  /// Acceleration, in world units per second squared.
  [[nodiscard]] Vec3 gravity() const;
  /// A new engine with these parameters.
  [[nodiscard]] std::unique_ptr<PhysicsEngine> createEngine();

 private:
  std::int64_t frames_ = 300;
  Choice engine_;
  double gravity_x_ = 0;
  double gravity_y_ = -9.81;
  double gravity_z_ = 0;
  PhysicsSettings physics_;
  std::unique_ptr<ChosenEngine> engine_parameters_;
};

/// A simulation with an authored scene as its document.
class SceneDocument {
 public:
  virtual ~SceneDocument() = default;
  /// The scene in its initial state, with the current parameters.
  [[nodiscard]] virtual AuthoredScene document() = 0;
};

/// The simulation of an authored scene; also a SceneDocument. `file`: the scene's path, if it was
/// saved. Throws InputError if a part of the scene is invalid.
std::unique_ptr<Simulation> makeAuthoredSimulation(AuthoredScene scene,
                                                   std::filesystem::path file = {});

/// Converts a frame of a recording or simulation to a scene, with all available data: a
/// SceneSource provides bodies with velocities and gravity; a PoseSource rotated bodies at rest;
/// any other source unrotated bodies at rest, one for each box. Leaves the source at that frame.
/// Throws InputError if there is no such frame, or a box in it cannot be a body.
AuthoredScene sceneFromFrame(FrameSource& source, std::uint32_t frame);

}  // namespace broadmark::scenes
