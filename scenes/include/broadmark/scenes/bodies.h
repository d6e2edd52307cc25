// The bodies of a running scene, by id, and their state in the last frame.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "broadmark/frame.h"
#include "broadmark/scenes/physics_engine.h"

namespace broadmark::scenes {

/// A body is absent, or in the engine, or part of the scenery: immovable bodies without a collision
/// response, which no engine simulates. Scenery takes no time.
class Bodies {
 public:
  /// Starts without present bodies. The engine must outlive this.
  Bodies(PhysicsEngine& engine, const SceneInfo& scene);

  [[nodiscard]] std::size_t size() const { return bodies_.size(); }
  /// The body with this id; null if not in the engine.
  [[nodiscard]] PhysicsBody* operator[](std::size_t id) const { return bodies_[id]; }
  /// Ids of the bodies in the engine, ascending, including those that vanished since the last
  /// frame. Valid until a body is added.
  [[nodiscard]] std::span<const std::uint32_t> inEngine();

  /// Adds the absent body `id` to the engine, with the layer and world of the scene's initial
  /// filter.
  PhysicsBody& add(std::size_t id, BodyDescription);
  /// Removes body `id` from the engine or the scenery.
  void remove(std::size_t id);
  /// Makes the absent body `id` part of the scenery. A body enters or leaves it at most once a
  /// frame.
  void place(std::size_t id, const Shape&, const Pose&);

  /// Gives body `id` another layer from the next recorded frame on; in the engine it keeps its own.
  /// Only if SceneInfo::filter_changes.
  void setLayer(std::size_t id, std::uint8_t layer);
  /// The filter of the last recorded frame.
  [[nodiscard]] const CollisionFilter& filter() const { return filter_; }

  /// Records the boxes of all bodies. O(bodies in the engine), or O(bodies) if filters change in
  /// the frame.
  Frame record(std::uint32_t frame);
  // For the last recorded frame, by id.
  [[nodiscard]] std::span<const Aabb> boxes() const { return boxes_; }
  [[nodiscard]] std::span<const Pose> poses() const { return poses_; }
  /// The mass in the body's description.
  [[nodiscard]] double massOf(std::size_t id) const { return masses_[id]; }

 private:
  void applyLayers();
  void setScenery(std::size_t id, const Aabb& box);

  PhysicsEngine* engine_;
  CollisionFilter initial_filter_;
  CollisionFilter filter_;
  bool filter_changes_;
  std::map<std::uint32_t, std::uint8_t> new_layers_;  ///< from the next frame on
  std::vector<std::uint32_t> filter_changed_;
  std::vector<PhysicsBody*> bodies_;
  std::vector<double> masses_;
  std::vector<Aabb> boxes_;
  std::vector<Pose> poses_;
  std::vector<std::uint32_t> ids_;    ///< in the engine, or vanished since the last frame
  std::vector<std::uint32_t> added_;  ///< bodies not merged into ids_ yet
  std::vector<std::uint32_t> changed_;
  std::vector<std::uint32_t> changed_scenery_;  ///< since the last frame
};

}  // namespace broadmark::scenes
