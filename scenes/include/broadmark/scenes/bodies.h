// The bodies of a running scene, by id, and where they were in the last frame.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "broadmark/frame.h"
#include "broadmark/scenes/physics_engine.h"

namespace broadmark::scenes {

/// A body is absent, or in the engine, or part of the scenery: what stays where it is for good, and
/// no engine knows. Bodies pass through the scenery, and it takes no time.
class Bodies {
 public:
  /// All are absent. The engine must live longer.
  Bodies(PhysicsEngine& engine, const SceneInfo& scene);

  [[nodiscard]] std::size_t size() const { return bodies_.size(); }
  /// Null: not in the engine.
  [[nodiscard]] PhysicsBody* operator[](std::size_t id) const { return bodies_[id]; }
  /// Ids of the bodies in the engine, ascending; those that vanished since the last frame, too.
  /// Valid until one is added.
  [[nodiscard]] std::span<const std::uint32_t> inEngine();

  /// Adds body `id`, which is absent, to the engine. Its layer and its world are the scene's.
  PhysicsBody& add(std::size_t id, BodyDescription);
  /// Body `id`, which is in the engine, vanishes.
  void remove(std::size_t id);
  /// Body `id`, which is absent, becomes part of the scenery.
  void place(std::size_t id, const Shape&, const Pose&);

  /// Takes down where all bodies are now. O(bodies in the engine).
  Frame record(std::uint32_t frame);
  // In the frame recorded last, by id.
  [[nodiscard]] std::span<const Aabb> boxes() const { return boxes_; }
  [[nodiscard]] std::span<const Pose> poses() const { return poses_; }
  /// As the body was described.
  [[nodiscard]] double massOf(std::size_t id) const { return masses_[id]; }

 private:
  PhysicsEngine* engine_;
  CollisionFilter filter_;
  std::vector<PhysicsBody*> bodies_;
  std::vector<double> masses_;
  std::vector<Aabb> boxes_;
  std::vector<Pose> poses_;
  std::vector<std::uint32_t> ids_;      ///< in the engine, or since the last frame vanished
  std::vector<std::uint32_t> arrived_;  ///< those that may not be among them yet
  std::vector<std::uint32_t> changed_;
};

}  // namespace broadmark::scenes
