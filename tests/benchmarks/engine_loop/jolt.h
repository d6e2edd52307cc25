// Jolt's BroadPhaseQuadTree: in each step the pairs of all active bodies, by the bodies' own boxes.
// A body is active while it moves, and in the step in which it is added.
#pragma once

#include "jolt/tree_bodies.h"
// Jolt's headers must follow the header above.
#include <Jolt/Physics/Collision/AABoxCast.h>
#include <Jolt/Physics/Collision/CastResult.h>
#include <Jolt/Physics/Collision/RayCast.h>

#include "benchmarks/engine_loop/loop.h"

namespace broadmark::benchmarks {

class JoltLoop final : public LoopBroadPhase {
 public:
  void change(const Step& step) override {
    step_ = &step;
    const bool is_first = bodies_.size() == 0;
    if (is_first) {
      bodies_.initialize(step.boxes.size(), layers_);
      for (const Aabb& box : step.boxes) bodies_.create(box, 0);
    }
    std::erase_if(added_, [&](JPH::BodyID id) {
      return step.is_active[id.GetIndex()] != 0 || isEmpty(step.boxes[id.GetIndex()]);
    });
    bodies_.deactivate(added_);  // they do not move
    bodies_.remove(idsOf(step.removed, removed_));
    for (const JPH::BodyID id : idsOf(step.added, added_)) bodies_.updateBounds(id);
    bodies_.add(added_);
    if (is_first) bodies_.trees().Optimize();
    bodies_.trees().LockModifications();
    for (const JPH::BodyID id : idsOf(step.moved, moved_)) bodies_.updateBounds(id);
    bodies_.notifyMoved(moved_.data(), moved_.size());
    bodies_.trees().UnlockModifications();
  }

  void findPairs() override {
    bodies_.rebuild();
    found_.pairs.clear();
    std::atomic<std::size_t> next = 0;
    bodies_.findPairs(layers_, next, found_);
  }

  void answer(const Batch& batch, Answers& answers) override {
    for (std::size_t i = 0; i < batch.boxes.size(); ++i) {
      const Aabb box = aabbOf(batch.boxes[i].box);
      BoxCollector collector(step_->boxes, box, i, answers);
      bodies_.trees().CollideAABox({joltVector(box.min), joltVector(box.max)}, collector, {}, {});
    }
    for (std::size_t i = 0; i < batch.rays.size(); ++i) {
      const bp::Cast& ray = batch.rays[i];
      RayCollector collector(step_->boxes, ray, answers.fractions[i]);
      bodies_.trees().CastRay({vectorOf(ray.box.min), vectorOf(ray.direction)}, collector, {}, {});
    }
  }

  void appendPairs(std::vector<Pair>& pairs) override {
    pairs.insert(pairs.end(), found_.pairs.begin(), found_.pairs.end());
  }
  [[nodiscard]] bool findsActiveOnly() const override { return true; }

 private:
  static JPH::Vec3 vectorOf(const float* xyz) { return {xyz[0], xyz[1], xyz[2]}; }

  /// One layer, which collides with itself.
  class Layers final : public JPH::BroadPhaseLayerInterface,
                       public JPH::ObjectVsBroadPhaseLayerFilter,
                       public JPH::ObjectLayerPairFilter {
   public:
    JPH::uint GetNumBroadPhaseLayers() const override { return 1; }
    JPH::BroadPhaseLayer GetBroadPhaseLayer(JPH::ObjectLayer) const override {
      return JPH::BroadPhaseLayer(0);
    }
#if defined(JPH_EXTERNAL_PROFILE) || defined(JPH_PROFILE_ENABLED)
    const char* GetBroadPhaseLayerName(JPH::BroadPhaseLayer) const override { return "layer"; }
#endif
    bool ShouldCollide(JPH::ObjectLayer, JPH::BroadPhaseLayer) const override { return true; }
    bool ShouldCollide(JPH::ObjectLayer, JPH::ObjectLayer) const override { return true; }
  };

  struct PairCollector final : JPH::BodyPairCollector {
    void AddHit(const JPH::BodyPair& pair) override {
      pairs.push_back(orderedPair(pair.mBodyA.GetIndex(), pair.mBodyB.GetIndex()));
    }

    std::vector<Pair> pairs;
  };

  // The trees test enlarged boxes.
  struct BoxCollector final : JPH::CollideShapeBodyCollector {
    BoxCollector(const std::vector<Aabb>& all, const Aabb& queried, std::size_t index, Answers& to)
        : boxes(all), box(queried), query(index), answers(to) {}
    void AddHit(const JPH::BodyID& id) override {
      if (overlaps(box, boxes[id.GetIndex()])) answers.addOverlap(query, id.GetIndex());
    }

    const std::vector<Aabb>& boxes;
    const Aabb& box;
    std::size_t query;
    Answers& answers;
  };
  struct RayCollector final : JPH::RayCastBodyCollector {
    RayCollector(const std::vector<Aabb>& all, const bp::Cast& cast, float& fraction)
        : boxes(all), ray(cast), closest(fraction) {}
    void AddHit(const JPH::BroadPhaseCastResult& near) override {
      const float fraction =
          entryOf(boxes[near.mBodyID.GetIndex()], ray.box.min, ray.direction, 0, 1);
      if (fraction >= GetEarlyOutFraction()) return;
      closest = fraction;
      UpdateEarlyOutFraction(fraction);
    }

    const std::vector<Aabb>& boxes;
    const bp::Cast& ray;
    float& closest;
  };

  JoltTreeBodies::Ids& idsOf(const Step::Slots& slots, JoltTreeBodies::Ids& ids) const {
    ids.clear();
    for (const std::uint32_t slot : slots) ids.push_back(bodies_.idOf(slot));
    return ids;
  }

  JoltLibrary library_;
  Layers layers_;
  JoltTreeBodies bodies_;
  const Step* step_ = nullptr;
  JoltTreeBodies::Ids removed_;
  JoltTreeBodies::Ids added_;
  JoltTreeBodies::Ids moved_;
  PairCollector found_;
};

}  // namespace broadmark::benchmarks
