// Authored scenes in motion, and frames of other scenes as authored ones.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "broadmark/scenes/authored_scene.h"
#include "broadmark/scenes/physics_simulation.h"
#include "broadmark/scenes/simulation.h"

namespace broadmark::scenes {

/// The typed parameters of an authored scene: frames, engine, gravity, those of physics, and those
/// that come with the engine.
class AuthoredParameters final : public Parametrised {
 public:
  /// Throws InputError for an unknown parameter or a bad value.
  explicit AuthoredParameters(const ParameterValues& stated = {});
  /// Takes over those parameters of another scene that an authored one has, too.
  AuthoredParameters(const ParameterValues& other, const Vec3& gravity);

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
  ChosenEngine engine_parameters_;
};

/// What simulates a document.
class SceneDocument {
 public:
  virtual ~SceneDocument() = default;
  /// The scene as it starts, with the present parameters.
  [[nodiscard]] virtual AuthoredScene document() = 0;
};

/// The simulation of an authored scene (also a SceneDocument), which it keeps a copy of; `file`:
/// where that lies, if anywhere. Throws InputError when a part of the scene is faulty.
std::unique_ptr<Simulation> makeAuthoredSimulation(AuthoredScene scene,
                                                   std::filesystem::path file = {});

/// Frame `frame` of any recording or simulation as a scene of its own, with all that is known:
/// of a SceneSource its bodies with velocities and forces; of poses the turned bodies, at rest; of
/// boxes alone those, unturned and at rest. Leaves the source at that frame. Throws InputError when
/// there is no such frame, or it holds what no body can be.
AuthoredScene sceneFromFrame(FrameSource& source, std::uint32_t frame);

}  // namespace broadmark::scenes
