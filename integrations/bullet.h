// Records a Bullet world: the boxes that its broad phase was given, and the pairs in its cache.
// Bullet 3.24. Copy this file and broadmark_recorder.h; MIT licence, as there.
//
//   broadmark_recorder recorder;
//   broadmark_record_begin(&recorder, "session", 5000);
//   each step: world.stepSimulation(dt);  broadmarkRecord(recorder, world);
//   broadmark_record_end(&recorder);
//
// A box is that of the proxy: the shape's, enlarged by gContactBreakingThreshold, 0.02, and swept
// if continuous collision detection is on. So boxes and pairs are those of the last internal step,
// before its bodies moved. The cache of btDbvtBroadphase also holds pairs that do not overlap:
// `audit --margin` allows these (docs/integrations.md of Broadmark says which).
//
// Group and mask of each proxy become a layer. A btOverlapFilterCallback of your own is not known:
// its pairs are reported as missed.
#ifndef BROADMARK_BULLET_H
#define BROADMARK_BULLET_H

#include <BulletCollision/CollisionDispatch/btCollisionWorld.h>

#include "broadmark_recorder.h"

/// Records a box by the proxy's id, which Bullet does not reuse as long as the body is in the
/// world.
inline bool broadmarkRecord(broadmark_recorder& recorder, const btBroadphaseProxy& proxy) {
  const double min[3] = {proxy.m_aabbMin[0], proxy.m_aabbMin[1], proxy.m_aabbMin[2]};
  const double max[3] = {proxy.m_aabbMax[0], proxy.m_aabbMax[1], proxy.m_aabbMax[2]};
  const unsigned layer =
      broadmark_record_layer(&recorder, static_cast<unsigned>(proxy.m_collisionFilterGroup),
                             static_cast<unsigned>(proxy.m_collisionFilterMask));
  return broadmark_record_box(&recorder, static_cast<unsigned>(proxy.m_uniqueId), min, max, layer,
                              BROADMARK_NO_TAG) != 0;
}

/// Records a frame. Returns false after an error, recorder.error.
inline bool broadmarkRecord(broadmark_recorder& recorder, btCollisionWorld& world) {
  const btCollisionObjectArray& objects = world.getCollisionObjectArray();
  for (int i = 0; i < objects.size(); ++i) {
    const btBroadphaseProxy* const proxy = objects[i]->getBroadphaseHandle();
    if (proxy != nullptr && !broadmarkRecord(recorder, *proxy)) return false;
  }
  const btBroadphasePairArray& pairs = world.getPairCache()->getOverlappingPairArray();
  for (int i = 0; i < pairs.size(); ++i) {
    if (!broadmark_record_pair(&recorder, static_cast<unsigned>(pairs[i].m_pProxy0->m_uniqueId),
                               static_cast<unsigned>(pairs[i].m_pProxy1->m_uniqueId))) {
      return false;
    }
  }
  return broadmark_record_frame(&recorder) != 0;
}

#endif
