// Records a PhysX scene: the boxes of its shapes, and the pairs that its broad phase has found and
// not lost. PhysX 5.6. Copy this file and broadmark_recorder.h; MIT licence, as there.
//
//   BroadmarkPhysx session;
//   session.begin("session", 5000);
//   PxSceneDesc desc(…);
//   desc.filterCallback = &session;                // pairs come from here
//   desc.filterShader = BroadmarkPhysx::shader;    // or your own, which adds PxFilterFlag::eNOTIFY
//   each step: session.boxes(scene);               // those that the broad phase is given
//              scene.simulate(dt);  scene.fetchResults(true);
//              session.pairs();
//   session.end();
//
// A box is the shape's, enlarged by its contact offset, as the broad phase is given it. PhysX
// passes no pair of two shapes of one actor, nor of two that are static or kinematic. Pairs that
// your filter shader kills are reported as missed; sleeping changes nothing. Triggers and
// articulations are left out. eSAP rounds boxes, which `audit --margin 1e-4` allows.
#ifndef BROADMARK_PHYSX_H
#define BROADMARK_PHYSX_H

#include <PxPhysicsAPI.h>

#include <mutex>
#include <unordered_map>
#include <utility>
#include <vector>

#include "broadmark_recorder.h"

class BroadmarkPhysx final : public physx::PxSimulationFilterCallback {
 public:
  bool begin(const char* name, uint32_t max_shapes) {
    const bool begun = broadmark_record_begin(&recorder_, name, max_shapes) != 0;
    if (begun) {
      moving_ = broadmark_record_layer(&recorder_, 1, 3);
      fixed_ = broadmark_record_layer(&recorder_, 2, 1);
    }
    return begun;
  }
  bool end() { return broadmark_record_end(&recorder_) != 0; }
  const char* error() const { return recorder_.error; }

  /// A filter shader that lets all pairs collide.
  static physx::PxFilterFlags shader(physx::PxFilterObjectAttributes, physx::PxFilterData,
                                     physx::PxFilterObjectAttributes, physx::PxFilterData,
                                     physx::PxPairFlags& flags, const void*, physx::PxU32) {
    flags = physx::PxPairFlag::eCONTACT_DEFAULT;
    return physx::PxFilterFlag::eNOTIFY;
  }

  /// Records the boxes before a step.
  void boxes(physx::PxScene& scene) {
    using namespace physx;
    const PxActorTypeFlags types = PxActorTypeFlag::eRIGID_STATIC | PxActorTypeFlag::eRIGID_DYNAMIC;
    std::vector<PxActor*> actors(scene.getNbActors(types));
    scene.getActors(types, actors.data(), static_cast<PxU32>(actors.size()));
    for (PxActor* const actor : actors) {
      const PxRigidActor& rigid = *static_cast<PxRigidActor*>(actor);
      const PxRigidBody* const body = actor->is<PxRigidBody>();
      const bool is_moving =
          body != nullptr && !(body->getRigidBodyFlags() & PxRigidBodyFlag::eKINEMATIC);
      std::vector<PxShape*> shapes(rigid.getNbShapes());
      rigid.getShapes(shapes.data(), static_cast<PxU32>(shapes.size()));
      for (const PxShape* const shape : shapes) {
        if (!isRecorded(actor, shape)) continue;
        PxBounds3 box = PxShapeExt::getWorldBounds(*shape, rigid, 1);
        box.fattenFast(shape->getContactOffset());
        const double min[3] = {box.minimum.x, box.minimum.y, box.minimum.z};
        const double max[3] = {box.maximum.x, box.maximum.y, box.maximum.z};
        const auto tag = static_cast<uint32_t>(reinterpret_cast<uintptr_t>(actor) >> 4);
        broadmark_record_box(&recorder_, idOf(actor, shape), min, max, is_moving ? moving_ : fixed_,
                             shapes.size() > 1 ? tag : BROADMARK_NO_TAG);
      }
    }
  }
  /// Records the pairs after the step, and ends the frame. Returns false after an error.
  bool pairs() {
    for (const auto& pair : pairs_) {
      broadmark_record_pair(&recorder_, pair.second.first, pair.second.second);
    }
    return broadmark_record_frame(&recorder_) != 0;
  }

  // PhysX calls these, from several threads at once.
  physx::PxFilterFlags pairFound(physx::PxU64 id, physx::PxFilterObjectAttributes,
                                 physx::PxFilterData, const physx::PxActor* a,
                                 const physx::PxShape* shape_a, physx::PxFilterObjectAttributes,
                                 physx::PxFilterData, const physx::PxActor* b,
                                 const physx::PxShape* shape_b, physx::PxPairFlags&) override {
    if (isRecorded(a, shape_a) && isRecorded(b, shape_b)) {
      const std::lock_guard<std::mutex> lock(mutex_);
      pairs_[id] = {idOf(a, shape_a), idOf(b, shape_b)};
    }
    return physx::PxFilterFlag::eNOTIFY;
  }
  void pairLost(physx::PxU64 id, physx::PxFilterObjectAttributes, physx::PxFilterData,
                physx::PxFilterObjectAttributes, physx::PxFilterData, bool) override {
    const std::lock_guard<std::mutex> lock(mutex_);
    pairs_.erase(id);
  }
  bool statusChange(physx::PxU64&, physx::PxPairFlags&, physx::PxFilterFlags&) override {
    return false;
  }

 private:
  static bool isRecorded(const physx::PxActor* actor, const physx::PxShape* shape) {
    const bool is_rigid = actor->is<physx::PxRigidStatic>() || actor->is<physx::PxRigidDynamic>();
    return is_rigid && shape != nullptr &&
           (shape->getFlags() & physx::PxShapeFlag::eSIMULATION_SHAPE);
  }
  /// Of a shape, which several actors may share.
  static uint64_t idOf(const physx::PxActor* actor, const physx::PxShape* shape) {
    return reinterpret_cast<uintptr_t>(actor) * 0x9E3779B97F4A7C15u +
           reinterpret_cast<uintptr_t>(shape);
  }

  broadmark_recorder recorder_{};
  unsigned moving_ = 0, fixed_ = 0;  ///< layers
  std::mutex mutex_;                 ///< for pairs_
  std::unordered_map<physx::PxU64, std::pair<uint64_t, uint64_t>> pairs_;
};

#endif
