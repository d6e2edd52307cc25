// PhysX's broad phase ABP (of which PABP, the default, is the multithreaded form), and its
// scene-query system, which holds the bodies again. The former takes created, updated and removed
// bodies and gives the pairs that began and ended, for boxes rounded outward by less than a
// 10^-5th. The latter is told of the bodies together with the queries, in whose time that counts;
// its tree is rebuilt bit by bit.
#pragma once

#include <array>

#include "benchmarks/engine_loop/loop.h"
#include "broadmark/pair_set.h"
#include "physx/library.h"

namespace broadmark::benchmarks {

class PhysXLoop final : public LoopBroadPhase {
 public:
  PhysXLoop() {
    physXFoundation();
    broad_phase_.reset(PxCreateBroadPhase(physx::PxBroadPhaseDesc(physx::PxBroadPhaseType::eABP)));
    queries_.reset(physx::PxCreateExternalSceneQuerySystem(physx::PxSceneQueryDesc(), 0));
    material_.reset(physXFactory().createMaterial(0, 0, 0));
    shape_.reset(physXFactory().createShape(physx::PxBoxGeometry(0.5F, 0.5F, 0.5F), *material_));
    if (!broad_phase_ || !queries_ || !shape_) throw UnsupportedError("PhysX: cannot be created");
  }
  ~PhysXLoop() override {
    queries_.reset();  // borrows the actors
  }

  void change(const Step& step) override {
    step_ = &step;
    if (bounds_.empty()) createBodies(step.boxes.size());
    for (const Step::Slots* const slots : {&step.added, &step.moved}) {
      for (const std::uint32_t body : *slots) {
        const Aabb& box = step.boxes[body];
        bounds_[body] = {vectorOf(box.min.data()), vectorOf(box.max.data())};
      }
    }
    // PhysX takes sorted lists.
    added_ = step.added;
    removed_ = step.removed;
    std::ranges::sort(added_);
    std::ranges::sort(removed_);
  }

  void findPairs() override {
    const auto count = [](const auto& bodies) { return static_cast<physx::PxU32>(bodies.size()); };
    broad_phase_->update(physx::PxBroadPhaseUpdateData(
        added_.data(), count(added_), step_->moved.data(), count(step_->moved), removed_.data(),
        count(removed_), bounds_.data(), groups_.data(), distances_.data(), count(bounds_) - 1));
    broad_phase_->fetchResults(results_);
    PhysXErrors::instance().check();
  }

  void answer(const Batch& batch, Answers& answers) override {
    updateQueries();
    const physx::PxQueryFilterData all_touches(physx::PxQueryFlag::eDYNAMIC |
                                               physx::PxQueryFlag::eNO_BLOCK);
    physx::PxOverlapBufferN<256> found;
    for (std::size_t i = 0; i < batch.boxes.size(); ++i) {
      const Aabb box = aabbOf(batch.boxes[i].box);
      const physx::PxBounds3 bounds(vectorOf(box.min.data()), vectorOf(box.max.data()));
      queries_->overlap(physx::PxBoxGeometry(bounds.getExtents()),
                        physx::PxTransform(bounds.getCenter()), found, all_touches);
      for (physx::PxU32 k = 0; k < found.getNbTouches(); ++k) {
        answers.addOverlap(i, bodyOf(*found.getTouch(k).actor));
      }
    }
    for (std::size_t i = 0; i < batch.rays.size(); ++i) {
      physx::PxVec3 direction = vectorOf(batch.rays[i].direction);
      const float length = direction.normalize();
      physx::PxRaycastBuffer hit;
      if (queries_->raycast(vectorOf(batch.rays[i].box.min), direction, length, hit,
                            physx::PxHitFlags(0))) {
        answers.fractions[i] = hit.block.distance / length;
      }
    }
  }

  void appendPairs(std::vector<Pair>& pairs) override {
    // PhysX does not report all pairs of removed bodies.
    ended_.clear();
    for (const Pair pair : pairs_.run()) {
      if (isEmpty(step_->boxes[pair.a]) || isEmpty(step_->boxes[pair.b])) ended_.push_back(pair);
    }
    pairs_.erase(ended_);
    for (physx::PxU32 i = 0; i < results_.mNbDeletedPairs; ++i) {
      const Pair pair = pairOf(results_.mDeletedPairs[i]);
      if (pairs_.contains(pair)) pairs_.erase({&pair, 1});
    }
    for (physx::PxU32 i = 0; i < results_.mNbCreatedPairs; ++i) {
      const Pair pair = pairOf(results_.mCreatedPairs[i]);
      pairs_.insert({&pair, 1});
    }
    pairs.insert(pairs.end(), pairs_.run().begin(), pairs_.run().end());
  }

 private:
  static physx::PxVec3 vectorOf(const float* xyz) { return {xyz[0], xyz[1], xyz[2]}; }
  static Pair pairOf(const physx::PxBroadPhasePair& pair) {
    return orderedPair(pair.mID0, pair.mID1);
  }
  static std::uint32_t bodyOf(const physx::PxActor& actor) {
    return static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(actor.userData));
  }

  void createBodies(std::size_t count) {
    // One more: PhysX reads past the last body.
    bounds_.assign(count + 1, physx::PxBounds3(physx::PxVec3(0), physx::PxVec3(0)));
    transforms_.assign(count + 1, physx::PxTransform32(physx::PxTransform(physx::PxIdentity)));
    distances_.assign(count + 1, 0);
    handles_.resize(count);
    for (std::uint32_t body = 0; body <= count; ++body) {
      groups_.push_back(physx::PxGetBroadPhaseDynamicFilterGroup(body));
    }
    for (std::uintptr_t body = 0; body < count; ++body) {
      actors_.emplace_back(
          physXFactory().createRigidDynamic(physx::PxTransform(physx::PxIdentity)));
      actors_.back()->userData = reinterpret_cast<void*>(body);
    }
  }

  /// As PxScene does: moved bodies all at once, by their bounds.
  void updateQueries() {
    for (const std::uint32_t body : step_->removed) {
      queries_->removeSQShape(*actors_[body], *shape_);
    }
    for (const std::uint32_t body : step_->added) {
      const physx::PxTransform pose(bounds_[body].getCenter());
      queries_->addSQShape(*actors_[body], *shape_, bounds_[body], pose);
      physx::PxU32 pruner;
      handles_[body] = queries_->getHandle(*actors_[body], *shape_, pruner);
    }
    moved_handles_.clear();
    for (const std::uint32_t body : step_->moved) {
      transforms_[body].p = bounds_[body].getCenter();
      moved_handles_.push_back(handles_[body]);
    }
    queries_->sync(physx::PX_SCENE_PRUNER_DYNAMIC, moved_handles_.data(), step_->moved.data(),
                   bounds_.data(), transforms_.data(),
                   static_cast<physx::PxU32>(moved_handles_.size()), physx::PxBitMap());
    queries_->finalizeUpdates();
  }

  PhysXPtr<physx::PxBroadPhase> broad_phase_;
  PhysXPtr<physx::PxMaterial> material_;
  PhysXPtr<physx::PxShape> shape_;  ///< of all bodies
  std::vector<PhysXPtr<physx::PxRigidDynamic>> actors_;
  PhysXPtr<physx::PxSceneQuerySystem> queries_;
  const Step* step_ = nullptr;
  std::vector<physx::PxU32> added_;
  std::vector<physx::PxU32> removed_;
  // By body, with an extra entry.
  std::vector<physx::PxBounds3> bounds_;
  std::vector<physx::PxTransform32> transforms_;
  std::vector<physx::PxBpFilterGroup> groups_;
  std::vector<float> distances_;
  std::vector<physx::PxSQPrunerHandle> handles_;  ///< by body
  std::vector<physx::PxSQPrunerHandle> moved_handles_;
  physx::PxBroadPhaseResults results_;
  PairSet pairs_;
  std::vector<Pair> ended_;
};

}  // namespace broadmark::benchmarks
