/* Records a Box3D world: the boxes of shapes, and the pairs that the trees of its broad phase find.
 * Box3D 0.1, C or C++. Copy this file and broadmark_recorder.h; MIT licence, as there.
 *
 *   broadmark_box3d session;
 *   broadmark_box3d_begin(&session, "session", 5000);
 *   each step: b3World_Step(world, dt, 4);  broadmark_box3d_record(&session, world, bodies, count);
 *   broadmark_record_end(&session.recorder);
 *
 * Box3D does not show the pairs that it retains. The recorder queries the trees with the box of
 * each dynamic shape, as b3UpdateBroadPhasePairs() does for those that moved. This checks the
 * trees, but not what Box3D does with their answers. The trees have boxes enlarged by up to
 * B3_MAX_AABB_MARGIN, 0.05, within which a shape may move and turn: `audit --margin` allows these
 * pairs.
 *
 * Shapes of one body are no pair, nor are those that filters or body types exclude: a layer is a
 * combination of type and filter, of which there may be 32. Sensors are left out; joints that
 * keep their bodies from colliding and custom filters are not known. */
#ifndef BROADMARK_BOX3D_H
#define BROADMARK_BOX3D_H

#include <box3d/box3d.h>

#include "broadmark_recorder.h"

typedef struct broadmark_box3d_category {
  b3Filter filter;
  bool is_dynamic;
  unsigned layer;
} broadmark_box3d_category;

typedef struct broadmark_box3d {
  broadmark_recorder recorder;
  int category_count;
  broadmark_box3d_category categories[32];
  b3ShapeId shape; /* whose pairs are searched */
} broadmark_box3d;

static inline int broadmark_box3d_begin(broadmark_box3d* s, const char* name, uint32_t max_shapes) {
  const int begun = broadmark_record_begin(&s->recorder, name, max_shapes);
  s->recorder.either = 1;
  s->category_count = 0;
  return begun;
}

static inline bool broadmark_box3d_collide(const broadmark_box3d_category* a,
                                           const broadmark_box3d_category* b) {
  if (!a->is_dynamic && !b->is_dynamic) return false;
  if (a->filter.groupIndex == b->filter.groupIndex && a->filter.groupIndex != 0) {
    return a->filter.groupIndex > 0;
  }
  return (a->filter.maskBits & b->filter.categoryBits) != 0 &&
         (a->filter.categoryBits & b->filter.maskBits) != 0;
}

static inline broadmark_box3d_category broadmark_box3d_category_of(b3ShapeId shape) {
  broadmark_box3d_category category;
  category.filter = b3Shape_GetFilter(shape);
  category.is_dynamic = b3Body_GetType(b3Shape_GetBody(shape)) == b3_dynamicBody;
  category.layer = 32;
  return category;
}

/* A category is a bit, by its number. Its mask has those before it that it collides with, and
 * itself. */
static inline unsigned broadmark_box3d_layer(broadmark_box3d* s, b3ShapeId shape) {
  broadmark_box3d_category category = broadmark_box3d_category_of(shape);
  uint64_t mask = 0;
  int i, k;
  for (i = 0; i < s->category_count; ++i) {
    const broadmark_box3d_category* const known = &s->categories[i];
    if (known->is_dynamic == category.is_dynamic &&
        known->filter.groupIndex == category.filter.groupIndex &&
        known->filter.maskBits == category.filter.maskBits &&
        known->filter.categoryBits == category.filter.categoryBits) {
      return known->layer;
    }
  }
  for (k = 0; k < i; ++k) {
    if (broadmark_box3d_collide(&category, &s->categories[k])) mask |= (uint64_t)1 << k;
  }
  if (broadmark_box3d_collide(&category, &category)) mask |= (uint64_t)1 << i;
  category.layer = broadmark_record_layer(&s->recorder, (uint64_t)1 << i, mask);
  if (category.layer < 32) s->categories[s->category_count++] = category;
  return category.layer;
}

/* Records a pair that a tree found. Two dynamic shapes find each other. */
static inline bool broadmark_box3d_pair(b3ShapeId other, void* context) {
  broadmark_box3d* const s = (broadmark_box3d*)context;
  const broadmark_box3d_category category = broadmark_box3d_category_of(s->shape);
  const broadmark_box3d_category other_category = broadmark_box3d_category_of(other);
  const uint64_t a = b3StoreShapeId(s->shape), b = b3StoreShapeId(other);
  if (b3Shape_IsSensor(other) || (other_category.is_dynamic && b <= a)) return true;
  if (B3_ID_EQUALS(b3Shape_GetBody(s->shape), b3Shape_GetBody(other))) return true;
  if (broadmark_box3d_collide(&category, &other_category))
    broadmark_record_pair(&s->recorder, a, b);
  return true;
}

/* Records a frame: the shapes of these bodies, which must be all. Returns 0 after an error,
 * session->recorder.error. */
static inline int broadmark_box3d_record(broadmark_box3d* s, b3WorldId world,
                                         const b3BodyId* bodies, int body_count) {
  int i, k, phase;
  for (phase = 0; phase < 2; ++phase) { /* all boxes, then all pairs */
    for (i = 0; i < body_count; ++i) {
      const int count = b3Body_GetShapeCount(bodies[i]);
      b3ShapeId* const shapes = (b3ShapeId*)malloc((size_t)(count + 1) * sizeof(b3ShapeId));
      if (shapes == NULL) return bmr_fail(&s->recorder, "not enough memory");
      b3Body_GetShapes(bodies[i], shapes, count);
      for (k = 0; k < count; ++k) {
        const b3AABB box = b3Shape_GetAABB(shapes[k]);
        const double min[3] = {box.lowerBound.x, box.lowerBound.y, box.lowerBound.z};
        const double max[3] = {box.upperBound.x, box.upperBound.y, box.upperBound.z};
        if (b3Shape_IsSensor(shapes[k])) continue;
        if (phase == 0) {
          broadmark_record_box(&s->recorder, b3StoreShapeId(shapes[k]), min, max,
                               broadmark_box3d_layer(s, shapes[k]),
                               count > 1 ? (uint32_t)bodies[i].index1 : BROADMARK_NO_TAG);
        } else if (b3Body_GetType(bodies[i]) == b3_dynamicBody) {
          s->shape = shapes[k];
          b3World_OverlapAABB(world, box, b3DefaultQueryFilter(), broadmark_box3d_pair, s);
        }
      }
      free(shapes);
    }
  }
  return broadmark_record_frame(&s->recorder);
}

#endif
