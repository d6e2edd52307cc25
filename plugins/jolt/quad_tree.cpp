// Jolt Physics' broad phase (BroadPhaseQuadTree): a tree with four children per node for each
// broad-phase layer. Moving bodies only enlarge the boxes of their ancestors; each frame rebuilds
// the enlarged part of the trees and then queries them with every active body. O(m + n log n) time
// for m moved bodies, O(n) space.
//
// The calls and their order are those of PhysicsSystem::Update(), the only documented use: queries
// by workers in batches of sixteen bodies, and Optimize() after adding all bodies ("Architecture of
// Jolt Physics", Broad Phase). As recommended there, each of our layers is an object layer and a
// broad-phase layer, so that non-colliding layers are separate. The speculative contact distance,
// which only the solver uses, is 0. The answer is exact: the last test uses the body's own box.
//
// Jolt takes a body's box from its shape, so the shapes here only return the current box.
//
// Library: Jolt Physics 5, J. Rouwe.

#include "broadmark/plugin.h"
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
#include <memory>
#include <string>
#include <vector>

namespace broadmark::jolt_quad_tree {
namespace {

/// The number of bodies per batch of queries: PhysicsSystem's cActiveBodiesBatchSize.
constexpr std::size_t kBatch = 16;

JPH::Vec3 vectorOf(const std::array<float, 4>& corner) { return {corner[0], corner[1], corner[2]}; }

/// A shape that is the world-space box of its body.
class BodyBox final : public JPH::Shape {
 public:
  /// `box` is not owned.
  explicit BodyBox(const Aabb& box)
      : Shape(JPH::EShapeType::User1, JPH::EShapeSubType::User1), box_(&box) {
    SetEmbedded();
  }

  JPH::AABox GetWorldSpaceBounds(JPH::Mat44Arg, JPH::Vec3Arg) const override {
    return {vectorOf(box_->min), vectorOf(box_->max)};
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

/// The layer matrix for Jolt. Each of our layers is an object layer and a broad-phase layer.
class Layers final : public JPH::BroadPhaseLayerInterface,
                     public JPH::ObjectVsBroadPhaseLayerFilter,
                     public JPH::ObjectLayerPairFilter {
 public:
  explicit Layers(const SceneInfo& scene) : matrix_(scene.filter.matrix()) {
    if (scene.filter_changes) count_ = LayerMatrix::kLayers;
    for (const std::uint8_t layer : scene.filter.layers()) count_ = std::max(count_, layer + 1U);
  }

  JPH::uint GetNumBroadPhaseLayers() const override { return count_; }
  JPH::BroadPhaseLayer GetBroadPhaseLayer(JPH::ObjectLayer layer) const override {
    return JPH::BroadPhaseLayer(static_cast<JPH::BroadPhaseLayer::Type>(layer));
  }
#if defined(JPH_EXTERNAL_PROFILE) || defined(JPH_PROFILE_ENABLED)
  const char* GetBroadPhaseLayerName(JPH::BroadPhaseLayer) const override { return "layer"; }
#endif
  bool ShouldCollide(JPH::ObjectLayer a, JPH::BroadPhaseLayer b) const override {
    return matrix_.collide(a, b.GetValue());
  }
  bool ShouldCollide(JPH::ObjectLayer a, JPH::ObjectLayer b) const override {
    return matrix_.collide(a, b);
  }

 private:
  LayerMatrix matrix_;
  JPH::uint count_ = 1;
};

/// Collects the pairs that Jolt finds.
class Pairs final : public JPH::BodyPairCollector {
 public:
  /// Neither is owned; `filter` is null if layers are the only filter.
  Pairs(PairBuffer& pairs, const CollisionFilter* filter) : pairs_(pairs), filter_(filter) {}

  void AddHit(const JPH::BodyPair& pair) override {
    const std::uint32_t a = pair.mBodyA.GetIndex();
    const std::uint32_t b = pair.mBodyB.GetIndex();
    if (filter_ == nullptr || filter_->wanted(a, b)) pairs_.add(a, b);
  }

 private:
  PairBuffer& pairs_;
  const CollisionFilter* filter_;
};

class QuadTree final : public BoxBroadPhase {
 public:
  QuadTree() = default;
  QuadTree(const QuadTree&) = delete;
  QuadTree& operator=(const QuadTree&) = delete;
  ~QuadTree() override {
    if (layers_ == nullptr) return;
    std::vector<JPH::BodyID> present;
    for (std::uint32_t body = 0; body < bodies_.size(); ++body) {
      if (isInTree(body)) present.push_back(bodies_[body]->GetID());
    }
    removeBodies(present);
    std::vector<JPH::BodyID> all;
    for (const JPH::Body* body : bodies_) all.push_back(body->GetID());
    if (!all.empty()) manager_.DestroyBodies(all.data(), static_cast<int>(all.size()));
  }

  void initialize(const SceneInfo& scene, const Frame& first,
                  ExecutionContext& execution) override {
    BoxBroadPhase::initialize(scene, first, execution);
    filter_ = scene.filter;
    layers_ = std::make_unique<Layers>(scene);
    manager_.Init(static_cast<JPH::uint>(std::max<std::size_t>(boxes().size(), 1)), 0, *layers_);
    trees_.Init(&manager_, *layers_);
    for (std::uint32_t body = 0; body < boxes().size(); ++body) create(body);
    added_.clear();
    for (const std::uint32_t body : first.presentBodies()) {
      bodies_[body]->CalculateWorldSpaceBoundsInternal();
      added_.push_back(bodies_[body]->GetID());
    }
    addBodies(added_);
    trees_.Optimize();
  }

  void updateObjects(const Frame& frame) override {
    BoxBroadPhase::updateObjects(frame);
    moved_.clear();
    added_.clear();
    removed_.clear();
    for (const std::uint32_t body : *frame.changed) {
      const bool is_present = !isEmpty(boxes()[body]);
      if (!is_present && !isInTree(body)) continue;
      const JPH::BodyID id = bodies_[body]->GetID();
      if (!isInTree(body)) {  // its layer may have changed
        manager_.SetBodyObjectLayerInternal(*bodies_[body],
                                            static_cast<JPH::ObjectLayer>(filter_.layerOf(body)));
      }
      (!is_present ? removed_ : !isInTree(body) ? added_ : moved_).push_back(id);
    }
  }

  void updateStructures() override {
    removeBodies(removed_);
    updateBounds(added_);
    addBodies(added_);
    trees_.LockModifications();
    updateBounds(moved_);
    notifyMoved();
    trees_.UnlockModifications();
    trees_.FrameSync();
    trees_.LockModifications();
    trees_.UpdateFinalize(trees_.UpdatePrepare());
    trees_.UnlockModifications();
  }

  void visitCounters(const CounterVisitor& visit) const override {
    visit("moves", moved_.size());
    visit("arrivals", added_.size());
    visit("removals", removed_.size());
  }

  [[nodiscard]] std::string validate() const override {
    for (std::uint32_t body = 0; body < bodies_.size(); ++body) {
      if (isInTree(body) == isEmpty(boxes()[body]))
        return "a tree missed a body that appeared or disappeared";
    }
    return {};
  }

 private:
  using Ids = std::vector<JPH::BodyID>;

  [[nodiscard]] bool isInTree(std::uint32_t body) const { return bodies_[body]->IsInBroadPhase(); }

  void create(std::uint32_t body) {
    shapes_.emplace_back(boxes()[body]);
    JPH::BodyCreationSettings settings(&shapes_.back(), JPH::RVec3::sZero(), JPH::Quat::sIdentity(),
                                       JPH::EMotionType::Dynamic,
                                       static_cast<JPH::ObjectLayer>(filter_.layerOf(body)));
    settings.mOverrideMassProperties = JPH::EOverrideMassProperties::MassAndInertiaProvided;
    settings.mMassPropertiesOverride = {1, JPH::Mat44::sIdentity()};
    bodies_.push_back(manager_.AllocateBody(settings));
    manager_.AddBodyWithCustomID(bodies_.back(), JPH::BodyID(body, 1));
  }

  /// May reorder the ids.
  void addBodies(Ids& ids) {
    if (ids.empty()) return;
    const int count = static_cast<int>(ids.size());
    trees_.AddBodiesFinalize(ids.data(), count, trees_.AddBodiesPrepare(ids.data(), count));
    manager_.ActivateBodies(ids.data(), count);
  }
  void removeBodies(Ids& ids) {
    if (ids.empty()) return;
    const int count = static_cast<int>(ids.size());
    manager_.DeactivateBodies(ids.data(), count);
    trees_.RemoveBodies(ids.data(), count);
  }

  void updateBounds(const Ids& ids) {
    team().run(ids.size(), [&](int, Range part) {
      for (std::size_t i = part.begin; i < part.end; ++i) {
        bodies_[ids[i].GetIndex()]->CalculateWorldSpaceBoundsInternal();
      }
    });
  }

  void notifyMoved() {
    team().run(moved_.size(), [&](int, Range part) {
      if (part.size() == 0) return;
      trees_.NotifyBodiesAABBChanged(moved_.data() + part.begin, static_cast<int>(part.size()),
                                     false);
    });
  }

  void findPairs() override {
    const JPH::BodyID* const active = manager_.GetActiveBodiesUnsafe(JPH::EBodyType::RigidBody);
    const std::size_t count = manager_.GetNumActiveBodies(JPH::EBodyType::RigidBody);
    const bool only_layers = filter_.worlds().empty() && filter_.tags().empty();
    std::atomic<std::size_t> next = 0;
    team().run([&](int worker) {
      Pairs found(pairs(worker), only_layers ? nullptr : &filter_);
      std::array<JPH::BodyID, kBatch> batch;
      for (std::size_t begin; (begin = next.fetch_add(kBatch)) < count;) {
        const std::size_t size = std::min(kBatch, count - begin);
        std::copy_n(active + begin, size, batch.begin());
        trees_.FindCollidingPairs(batch.data(), static_cast<int>(size), 0, *layers_, *layers_,
                                  found);
      }
    });
  }

  JoltLibrary library_;
  CollisionFilter filter_;
  std::unique_ptr<Layers> layers_;
  std::deque<BodyBox> shapes_;  ///< by body
  JPH::BodyManager manager_;
  JPH::BroadPhaseQuadTree trees_;
  std::vector<JPH::Body*> bodies_;  ///< owned by manager_
  // Of the current frame.
  Ids moved_;
  Ids added_;
  Ids removed_;
};

}  // namespace

std::vector<Algorithm> variants() {
  Algorithm algorithm = {.id = "jolt-quadtree",
                         .family = "Jolt",
                         .summary = "Jolt Physics' quad trees, queried by every body",
                         .traits = {.incremental = true,
                                    .library_allocates = true,
                                    .changing_worlds = ChangingWorlds::native,
                                    .instance_per_world = true,
                                    .max_objects = JPH::BodyID::cMaxBodyIndex},
                         .description = {.principle = "tree",
                                         .optimisations = "incremental, a tree for each layer",
                                         .time = "O(m + n log n), m bodies that move",
                                         .space = "O(n)",
                                         .source = "Jolt Physics 5, BroadPhaseQuadTree"},
                         .create = [] { return std::make_unique<QuadTree>(); }};
  Algorithm parallel = algorithm;
  parallel.id += "-mt";
  parallel.summary += ", on several threads";
  parallel.traits.parallel = true;
  return {algorithm, parallel};
}

}  // namespace broadmark::jolt_quad_tree

BROADMARK_PLUGIN(broadmark::jolt_quad_tree::variants);
