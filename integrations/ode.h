/* Records an ODE space: the boxes of its geoms, and the pairs that dSpaceCollide() reports. ODE
 * 0.16, C or C++. Copy this file and broadmark_recorder.h; MIT licence, as there.
 *
 *   broadmark_recorder recorder;
 *   broadmark_record_begin(&recorder, "session", 5000);
 *   each step: broadmark_record_space(&recorder, space);  // before dWorldStep()
 *   broadmark_record_end(&recorder);
 *
 * Geoms of inner spaces are recorded, the spaces themselves are not. Disabled geoms are absent.
 * Category and collide bits become a layer. Geoms of the same body get a common tag, since ODE
 * reports no pair of them. Infinite boxes, as of planes, end at the largest float;
 * a sweep-and-prune space reports them with all geoms, which the audit calls false. Quad-tree
 * spaces are refused. */
#ifndef BROADMARK_ODE_H
#define BROADMARK_ODE_H

#include <ode/ode.h>

#include "broadmark_recorder.h"

/* Only bodies of several geoms need one. Addresses are unique within 64 GiB. */
static inline uint32_t broadmark_ode_tag(dBodyID body) {
  if (body == NULL || dBodyGetNextGeom(dBodyGetFirstGeom(body)) == NULL) return BROADMARK_NO_TAG;
  return (uint32_t)((uintptr_t)body >> 4);
}

static inline void broadmark_ode_boxes(broadmark_recorder* recorder, dSpaceID space) {
  int i;
  if (dSpaceGetClass(space) == dQuadTreeSpaceClass) { /* dSpaceGetGeom() would end the program */
    bmr_fail(recorder, "ODE cannot list the geoms of a quad-tree space");
    return;
  }
  for (i = 0; i < dSpaceGetNumGeoms(space); ++i) {
    const dGeomID geom = dSpaceGetGeom(space, i);
    dReal box[6];
    double min[3], max[3];
    int axis;
    if (!dGeomIsEnabled(geom)) continue;
    if (dGeomIsSpace(geom)) {
      broadmark_ode_boxes(recorder, (dSpaceID)geom);
      continue;
    }
    dGeomGetAABB(geom, box);
    for (axis = 0; axis < 3; ++axis) {
      min[axis] = box[2 * axis];
      max[axis] = box[2 * axis + 1];
    }
    broadmark_record_box(
        recorder, (uintptr_t)geom, min, max,
        broadmark_record_layer(recorder, dGeomGetCategoryBits(geom), dGeomGetCollideBits(geom)),
        broadmark_ode_tag(dGeomGetBody(geom)));
  }
}

static inline void broadmark_ode_pair(void* recorder, dGeomID a, dGeomID b) {
  if (dGeomIsSpace(a) || dGeomIsSpace(b)) {
    dSpaceCollide2(a, b, recorder, broadmark_ode_pair);
  } else {
    broadmark_record_pair((broadmark_recorder*)recorder, (uintptr_t)a, (uintptr_t)b);
  }
}

static inline void broadmark_ode_pairs(broadmark_recorder* recorder, dSpaceID space) {
  int i;
  dSpaceCollide(space, recorder, broadmark_ode_pair);
  for (i = 0; i < dSpaceGetNumGeoms(space); ++i) {
    const dGeomID geom = dSpaceGetGeom(space, i);
    if (dGeomIsSpace(geom) && dGeomIsEnabled(geom)) broadmark_ode_pairs(recorder, (dSpaceID)geom);
  }
}

/* Records a frame. Returns 0 after an error, recorder->error. */
static inline int broadmark_record_space(broadmark_recorder* recorder, dSpaceID space) {
  recorder->either = 1; /* ODE's rule for categories */
  broadmark_ode_boxes(recorder, space);
  if (recorder->error[0] == 0) broadmark_ode_pairs(recorder, space);
  return broadmark_record_frame(recorder);
}

#endif
