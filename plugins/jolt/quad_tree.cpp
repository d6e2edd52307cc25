// Jolt Physics' broad phase (BroadPhaseQuadTree): a tree with four children per node for each
// broad-phase layer. Moving bodies only enlarge the boxes of their ancestors; each frame rebuilds
// the enlarged part of the trees and then queries them with every active body. O(m + n log n) time
// for m moved bodies, O(n) space.
//
// As "Architecture of Jolt Physics" recommends, each of our layers is an object layer and a
// broad-phase layer, so that non-colliding layers are separate. The answer is exact: the last test
// uses the body's own box.
//
// Library: Jolt Physics 5, J. Rouwe.

#include <algorithm>
#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "broadmark/plugin.h"
#include "jolt/tree_bodies.h"

namespace broadmark::jolt_quad_tree {
namespace {

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
  void initialize(const SceneInfo& scene, const Frame& first,
                  ExecutionContext& execution) override {
    BoxBroadPhase::initialize(scene, first, execution);
    filter_ = scene.filter;
    layers_ = std::make_unique<Layers>(scene);
    bodies_.initialize(boxes().size(), *layers_);
    for (std::uint32_t body = 0; body < boxes().size(); ++body) {
      bodies_.create(boxes()[body], layerOf(body));
    }
    added_.clear();
    for (const std::uint32_t body : first.presentBodies()) added_.push_back(bodies_.idOf(body));
    for (const JPH::BodyID id : added_) bodies_.updateBounds(id);
    bodies_.add(added_);
    bodies_.trees().Optimize();
  }

  void updateObjects(const Frame& frame) override {
    BoxBroadPhase::updateObjects(frame);
    moved_.clear();
    added_.clear();
    removed_.clear();
    for (const std::uint32_t body : *frame.changed) {
      const bool is_present = !isEmpty(boxes()[body]);
      const bool was_present = bodies_.isInTree(body);
      if (!is_present && !was_present) continue;
      if (!was_present) bodies_.setLayer(body, layerOf(body));  // it may have changed
      (!is_present ? removed_ : !was_present ? added_ : moved_).push_back(bodies_.idOf(body));
    }
  }

  void updateStructures() override {
    bodies_.remove(removed_);
    updateBounds(added_);
    bodies_.add(added_);
    bodies_.trees().LockModifications();
    updateBounds(moved_);
    team().run(moved_.size(), [&](int, Range part) {
      bodies_.notifyMoved(moved_.data() + part.begin, part.size());
    });
    bodies_.trees().UnlockModifications();
    bodies_.rebuild();
  }

  void visitCounters(const CounterVisitor& visit) const override {
    visit("moves", moved_.size());
    visit("arrivals", added_.size());
    visit("removals", removed_.size());
  }

  [[nodiscard]] std::string validate() const override {
    for (std::uint32_t body = 0; body < bodies_.size(); ++body) {
      if (bodies_.isInTree(body) == isEmpty(boxes()[body]))
        return "a tree missed a body that appeared or disappeared";
    }
    return {};
  }

 private:
  using Ids = JoltTreeBodies::Ids;

  [[nodiscard]] JPH::ObjectLayer layerOf(std::uint32_t body) const {
    return static_cast<JPH::ObjectLayer>(filter_.layerOf(body));
  }

  void updateBounds(const Ids& ids) {
    team().run(ids.size(), [&](int, Range part) {
      for (std::size_t i = part.begin; i < part.end; ++i) bodies_.updateBounds(ids[i]);
    });
  }

  void findPairs() override {
    const bool only_layers = filter_.worlds().empty() && filter_.tags().empty();
    std::atomic<std::size_t> next = 0;
    team().run([&](int worker) {
      Pairs found(pairs(worker), only_layers ? nullptr : &filter_);
      bodies_.findPairs(*layers_, next, found);
    });
  }

  JoltLibrary library_;
  CollisionFilter filter_;
  std::unique_ptr<Layers> layers_;
  JoltTreeBodies bodies_;
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
