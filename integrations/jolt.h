// Records a Jolt world: the boxes of its bodies, and the pairs that its broad phase finds for
// active bodies, as PhysicsSystem::Update() asks for them. Jolt 5.5. Copy this file and
// broadmark_recorder.h; MIT licence, as there.
//
//   BroadmarkJolt session;
//   session.begin("session", 5000);
//   each step: system.Update(…);  session.record(system);
//   session.end();
//
// Jolt finds no pair of two bodies that sleep, nor of two that are not dynamic, unless one is a
// sensor or wants it. So bodies that differ in any of this or in their object layer are in
// different layers of the recording: at most 32. A pair that the object layers allow and the
// broad-phase layers do not is reported as missed. Soft bodies are left out; a GroupFilter is not
// known. Jolt enlarges the boxes of active bodies by mSpeculativeContactDistance, 0.02: allow these
// pairs by `audit --margin 0.01`.
#ifndef BROADMARK_JOLT_H
#define BROADMARK_JOLT_H

#include <Jolt/Jolt.h>
// Must precede Jolt's other headers.
#include <Jolt/Physics/Body/Body.h>
#include <Jolt/Physics/Body/BodyLockInterface.h>
#include <Jolt/Physics/Collision/BroadPhase/BroadPhase.h>
#include <Jolt/Physics/PhysicsSystem.h>

#include <vector>

#include "broadmark_recorder.h"

class BroadmarkJolt {
 public:
  bool begin(const char* name, uint32_t max_bodies) {
    const bool begun = broadmark_record_begin(&recorder_, name, max_bodies) != 0;
    recorder_.either = 1;
    return begun;
  }
  bool end() { return broadmark_record_end(&recorder_) != 0; }
  const char* error() const { return recorder_.error; }

  /// Records a frame, between two updates. Returns false after an error.
  bool record(const JPH::PhysicsSystem& system) {
    const JPH::BodyLockInterface& bodies = system.GetBodyLockInterfaceNoLock();
    JPH::BodyIDVector ids;
    system.GetBodies(ids);
    for (const JPH::BodyID id : ids) {
      const JPH::Body* const body = bodies.TryGetBody(id);
      if (body == nullptr || !body->IsInBroadPhase() || body->IsSoftBody()) continue;
      const JPH::AABox& box = body->GetWorldSpaceBounds();
      const double min[3] = {box.mMin.GetX(), box.mMin.GetY(), box.mMin.GetZ()};
      const double max[3] = {box.mMax.GetX(), box.mMax.GetY(), box.mMax.GetZ()};
      broadmark_record_box(&recorder_, id.GetIndexAndSequenceNumber(), min, max,
                           layerOf(*body, system.GetObjectLayerPairFilter()), BROADMARK_NO_TAG);
    }
    system.GetActiveBodies(JPH::EBodyType::RigidBody, ids);
    Pairs pairs(recorder_, bodies);
    if (!ids.empty()) {
      static_cast<const JPH::BroadPhase&>(system.GetBroadPhaseQuery())
          .FindCollidingPairs(ids.data(), static_cast<int>(ids.size()),
                              system.GetPhysicsSettings().mSpeculativeContactDistance,
                              system.GetObjectVsBroadPhaseLayerFilter(),
                              system.GetObjectLayerPairFilter(), pairs);
    }
    return broadmark_record_frame(&recorder_) != 0;
  }

 private:
  /// What decides whether two bodies can be a pair.
  struct Category {
    explicit Category(const JPH::Body& body)
        : layer(body.GetObjectLayer()),
          active(body.IsActive()),
          dynamic(body.IsDynamic()),
          kinematic(body.IsKinematic()),
          sensor(body.IsSensor()),
          any_motion(body.GetCollideKinematicVsNonDynamic()) {}
    bool operator==(const Category& b) const {
      return layer == b.layer && active == b.active && dynamic == b.dynamic &&
             kinematic == b.kinematic && sensor == b.sensor && any_motion == b.any_motion;
    }
    bool collides(const Category& b) const {
      return (active || b.active) && (dynamic || b.dynamic || any_motion || b.any_motion ||
                                      (kinematic && b.sensor) || (sensor && b.kinematic));
    }

    JPH::ObjectLayer layer;
    bool active, dynamic, kinematic, sensor, any_motion;
  };

  struct Pairs final : JPH::BodyPairCollector {
    Pairs(broadmark_recorder& to, const JPH::BodyLockInterface& all) : recorder(to), bodies(all) {}
    void AddHit(const JPH::BodyPair& pair) override {
      const JPH::Body* const other = bodies.TryGetBody(pair.mBodyB);
      if (other != nullptr && other->IsSoftBody()) return;
      broadmark_record_pair(&recorder, pair.mBodyA.GetIndexAndSequenceNumber(),
                            pair.mBodyB.GetIndexAndSequenceNumber());
    }
    broadmark_recorder& recorder;
    const JPH::BodyLockInterface& bodies;
  };

  /// A category is a bit, by its number. Its mask has those before it that it collides with, and
  /// itself.
  unsigned layerOf(const JPH::Body& body, const JPH::ObjectLayerPairFilter& filter) {
    const Category category(body);
    size_t i = 0;
    while (i < categories_.size() && !(categories_[i] == category)) ++i;
    if (i < layers_.size()) return layers_[i];
    categories_.push_back(category);
    uint64_t mask = 0;
    for (size_t k = 0; k <= i && k < 32; ++k) {
      if (category.collides(categories_[k]) &&
          filter.ShouldCollide(category.layer, categories_[k].layer)) {
        mask |= uint64_t{1} << k;
      }
    }
    layers_.push_back(broadmark_record_layer(&recorder_, uint64_t{1} << (i % 64), mask));
    return layers_[i];
  }

  broadmark_recorder recorder_{};
  std::vector<Category> categories_;
  std::vector<unsigned> layers_;  ///< by category
};

#endif
