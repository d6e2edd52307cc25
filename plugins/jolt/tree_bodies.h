// The bodies and trees of Jolt's broad phase (BroadPhaseQuadTree), without the rest of its world.
//
// The calls and their order are those of PhysicsSystem::Update(), the only documented use: queries
// by workers in batches of sixteen bodies, and Optimize() after adding all bodies ("Architecture of
// Jolt Physics", Broad Phase). The speculative contact distance, which only the solver uses, is 0.
#pragma once

#include "jolt/library.h"
// Jolt's headers must follow the header above.
#include <Jolt/Physics/Body/BodyCreationSettings.h>
#include <Jolt/Physics/Body/BodyManager.h>
#include <Jolt/Physics/Body/BodyPair.h>
#include <Jolt/Physics/Collision/BroadPhase/BroadPhaseQuadTree.h>
#include <Jolt/Physics/Collision/Shape/Shape.h>
#include <Jolt/Physics/Collision/ShapeCast.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <deque>
#include <vector>

#include "broadmark/aabb.h"

namespace broadmark {

inline JPH::Vec3 joltVector(const std::array<float, 4>& corner) {
  return {corner[0], corner[1], corner[2]};
}

/// A shape that is the world-space box of its body.
class JoltBodyBox final : public JPH::Shape {
 public:
  /// `box` is not owned.
  explicit JoltBodyBox(const Aabb& box)
      : Shape(JPH::EShapeType::User1, JPH::EShapeSubType::User1), box_(&box) {
    SetEmbedded();
  }

  JPH::AABox GetWorldSpaceBounds(JPH::Mat44Arg, JPH::Vec3Arg) const override {
    return {joltVector(box_->min), joltVector(box_->max)};
  }
  JPH::AABox GetLocalBounds() const override { return {JPH::Vec3::sZero(), JPH::Vec3::sZero()}; }

  // The broad phase uses none of the functions below.
  JPH::uint GetSubShapeIDBitsRecursive() const override { return 0; }
  float GetInnerRadius() const override { return 0; }
  JPH::MassProperties GetMassProperties() const override { return {}; }
  const JPH::PhysicsMaterial* GetMaterial(const JPH::SubShapeID&) const override { return nullptr; }
  JPH::Vec3 GetSurfaceNormal(const JPH::SubShapeID&, JPH::Vec3Arg) const override {
    return JPH::Vec3::sAxisY();
  }
  void GetSubmergedVolume(JPH::Mat44Arg, JPH::Vec3Arg, const JPH::Plane&, float& total,
                          float& submerged, JPH::Vec3& centre
#ifdef JPH_DEBUG_RENDERER
                          ,
                          JPH::RVec3Arg
#endif
  ) const override {
    total = submerged = 0;
    centre = JPH::Vec3::sZero();
  }
#ifdef JPH_DEBUG_RENDERER
  void Draw(JPH::DebugRenderer*, JPH::RMat44Arg, JPH::Vec3Arg, JPH::ColorArg, bool,
            bool) const override {}
#endif
  bool CastRay(const JPH::RayCast&, const JPH::SubShapeIDCreator&,
               JPH::RayCastResult&) const override {
    return false;
  }
  void CastRay(const JPH::RayCast&, const JPH::RayCastSettings&, const JPH::SubShapeIDCreator&,
               JPH::CastRayCollector&, const JPH::ShapeFilter&) const override {}
  void CollidePoint(JPH::Vec3Arg, const JPH::SubShapeIDCreator&, JPH::CollidePointCollector&,
                    const JPH::ShapeFilter&) const override {}
  void CollideSoftBodyVertices(JPH::Mat44Arg, JPH::Vec3Arg,
                               const JPH::CollideSoftBodyVertexIterator&, JPH::uint,
                               int) const override {}
  void GetTrianglesStart(GetTrianglesContext&, const JPH::AABox&, JPH::Vec3Arg, JPH::QuatArg,
                         JPH::Vec3Arg) const override {}
  int GetTrianglesNext(GetTrianglesContext&, int, JPH::Float3*,
                       const JPH::PhysicsMaterial**) const override {
    return 0;
  }
  Stats GetStats() const override { return {sizeof(*this), 0}; }
  float GetVolume() const override { return 0; }

 private:
  const Aabb* box_;
};

/// Jolt's bodies, each with a box of the caller's, and the trees that hold those present.
class JoltTreeBodies {
 public:
  using Ids = std::vector<JPH::BodyID>;

  JoltTreeBodies() = default;
  JoltTreeBodies(const JoltTreeBodies&) = delete;
  JoltTreeBodies& operator=(const JoltTreeBodies&) = delete;
  ~JoltTreeBodies() {
    Ids present;
    Ids all;
    for (std::uint32_t body = 0; body < size(); ++body) {
      all.push_back(idOf(body));
      if (isInTree(body)) present.push_back(idOf(body));
    }
    remove(present);
    if (!all.empty()) manager_.DestroyBodies(all.data(), static_cast<int>(all.size()));
  }

  /// `layers` is not owned.
  void initialize(std::size_t max_bodies, const JPH::BroadPhaseLayerInterface& layers) {
    manager_.Init(static_cast<JPH::uint>(std::max<std::size_t>(max_bodies, 1)), 0, layers);
    trees_.Init(&manager_, layers);
  }

  /// Creates the next body, in no tree yet. `box` is not owned.
  void create(const Aabb& box, JPH::ObjectLayer layer) {
    shapes_.emplace_back(box);
    JPH::BodyCreationSettings settings(&shapes_.back(), JPH::RVec3::sZero(), JPH::Quat::sIdentity(),
                                       JPH::EMotionType::Dynamic, layer);
    settings.mOverrideMassProperties = JPH::EOverrideMassProperties::MassAndInertiaProvided;
    settings.mMassPropertiesOverride = {1, JPH::Mat44::sIdentity()};
    const auto index = static_cast<std::uint32_t>(bodies_.size());
    bodies_.push_back(manager_.AllocateBody(settings));
    manager_.AddBodyWithCustomID(bodies_.back(), JPH::BodyID(index, 1));
  }

  [[nodiscard]] std::size_t size() const { return bodies_.size(); }
  [[nodiscard]] JPH::BodyID idOf(std::uint32_t body) const { return bodies_[body]->GetID(); }
  [[nodiscard]] bool isInTree(std::uint32_t body) const { return bodies_[body]->IsInBroadPhase(); }
  void setLayer(std::uint32_t body, JPH::ObjectLayer layer) {
    manager_.SetBodyObjectLayerInternal(*bodies_[body], layer);
  }

  /// Reads the box of a body again.
  void updateBounds(JPH::BodyID id) { bodies_[id.GetIndex()]->CalculateWorldSpaceBoundsInternal(); }

  /// The bodies are active afterwards. May reorder the ids.
  void add(Ids& ids) {
    if (ids.empty()) return;
    const int count = static_cast<int>(ids.size());
    trees_.AddBodiesFinalize(ids.data(), count, trees_.AddBodiesPrepare(ids.data(), count));
    manager_.ActivateBodies(ids.data(), count);
  }
  void remove(Ids& ids) {
    if (ids.empty()) return;
    deactivate(ids);
    trees_.RemoveBodies(ids.data(), static_cast<int>(ids.size()));
  }
  /// FindCollidingPairs() reports no pairs of two inactive bodies.
  void deactivate(const Ids& ids) {
    manager_.DeactivateBodies(ids.data(), static_cast<int>(ids.size()));
  }

  /// Passes the new bounds of bodies to the trees; modifications must be locked. Several threads
  /// may do so at once, for different bodies.
  void notifyMoved(JPH::BodyID* ids, std::size_t count) {
    if (count == 0) return;
    trees_.NotifyBodiesAABBChanged(ids, static_cast<int>(count), false);
  }
  [[nodiscard]] JPH::BroadPhaseQuadTree& trees() { return trees_; }

  /// Rebuilds what notified moves have enlarged.
  void rebuild() {
    trees_.FrameSync();
    trees_.LockModifications();
    trees_.UpdateFinalize(trees_.UpdatePrepare());
    trees_.UnlockModifications();
  }

  /// Finds the pairs of active bodies. Threads that share `next`, 0 at first, share the work.
  template <class Layers>
  void findPairs(const Layers& layers, std::atomic<std::size_t>& next,
                 JPH::BodyPairCollector& found) const {
    constexpr std::size_t kBatch = 16;  // PhysicsSystem's cActiveBodiesBatchSize
    const JPH::BodyID* const active = manager_.GetActiveBodiesUnsafe(JPH::EBodyType::RigidBody);
    const std::size_t count = manager_.GetNumActiveBodies(JPH::EBodyType::RigidBody);
    std::array<JPH::BodyID, kBatch> batch;
    for (std::size_t begin; (begin = next.fetch_add(kBatch)) < count;) {
      const std::size_t size = std::min(kBatch, count - begin);
      std::copy_n(active + begin, size, batch.begin());
      trees_.FindCollidingPairs(batch.data(), static_cast<int>(size), 0, layers, layers, found);
    }
  }

 private:
  std::deque<JoltBodyBox> shapes_;  ///< by body
  JPH::BodyManager manager_;
  JPH::BroadPhaseQuadTree trees_;
  std::vector<JPH::Body*> bodies_;  ///< owned by manager_
};

}  // namespace broadmark
