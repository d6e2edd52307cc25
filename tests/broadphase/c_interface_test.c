/* The C interface of the broad-phase library, compiled as C: every function, every status. */

#include "broadmark/broadphase.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int failures = 0;

#define EXPECT(condition)                                             \
  do {                                                                \
    if (!(condition)) {                                               \
      fprintf(stderr, "%s:%d: %s\n", __FILE__, __LINE__, #condition); \
      ++failures;                                                     \
    }                                                                 \
  } while (0)

#define EXPECT_ERROR(status, call, message)                                \
  do {                                                                     \
    EXPECT((call) == (status));                                            \
    if (strstr(bm_last_error(), message) == NULL) {                        \
      fprintf(stderr, "%s:%d: %s\n", __FILE__, __LINE__, bm_last_error()); \
      ++failures;                                                          \
    }                                                                      \
  } while (0)

enum { kBodies = 300 };

static bm_box boxes[kBodies];
static const bm_boxes view = {boxes[0].min, boxes[0].max, kBodies, sizeof(bm_box)};

static void move(unsigned seed) {
  for (int i = 0; i < kBodies; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      seed = seed * 1664525U + 1013904223U;
      boxes[i].min[axis] = (float)(seed >> 16 & 255) * 0.05F;
      boxes[i].max[axis] = boxes[i].min[axis] + 1;
    }
  }
}

static int overlap(const bm_box* a, const bm_box* b) {
  for (int axis = 0; axis < 3; ++axis) {
    if (a->min[axis] > b->max[axis] || b->min[axis] > a->max[axis]) return 0;
  }
  return 1;
}

/* Whether these are all pairs, ascending. */
static int are_right(bm_pairs pairs) {
  size_t next = 0;
  for (uint32_t a = 0; a < kBodies; ++a) {
    for (uint32_t b = a + 1; b < kBodies; ++b) {
      if (!overlap(&boxes[a], &boxes[b])) continue;
      if (next == pairs.count || pairs.pairs[next].a != a || pairs.pairs[next].b != b) return 0;
      ++next;
    }
  }
  return next == pairs.count && next > 0;
}

static void run_backwards(void* user, int jobs, void (*job)(void* context, int i), void* context) {
  *(int*)user += jobs;
  while (jobs > 0) job(context, --jobs);
}

static void test_pairs(void) {
  bm_broadphase* object = NULL;
  bm_pairs pairs;
  EXPECT(bm_create(NULL, &object) == BM_OK);
  for (unsigned frame = 0; frame < 5; ++frame) {
    move(frame);
    EXPECT(bm_update(object, view) == BM_OK);
    EXPECT(bm_get_pairs(object, &pairs) == BM_OK);
    EXPECT(are_right(pairs));
  }
  bm_destroy(object);
  bm_destroy(NULL);
}

static void test_events(void) {
  bm_options options;
  bm_default_options(&options);
  options.answer = BM_ANSWER_EVENTS;
  options.method = BM_METHOD_COLUMNS;
  bm_broadphase* object = NULL;
  bm_pairs began, ended;
  EXPECT(bm_create(&options, &object) == BM_OK);
  move(1);
  EXPECT(bm_update(object, view) == BM_OK);
  EXPECT(bm_get_events(object, &began, &ended) == BM_OK);
  EXPECT(are_right(began) && ended.count == 0);
  EXPECT(bm_update(object, view) == BM_OK);
  EXPECT(bm_get_events(object, &began, &ended) == BM_OK);
  EXPECT(began.count == 0 && ended.count == 0);
  EXPECT_ERROR(BM_MISUSE, bm_get_pairs(object, &began), "events");
  bm_destroy(object);
}

static void test_filters(void) {
  bm_options options;
  bm_default_options(&options);
  options.collides[1] &= ~2U; /* layer 1: not with itself */
  bm_broadphase* object = NULL;
  bm_pairs pairs;
  EXPECT(bm_create(&options, &object) == BM_OK);
  const uint32_t tags[3] = {7, BM_NO_TAG, BM_NO_TAG};
  for (uint32_t i = 0; i < 4; ++i) {
    EXPECT(bm_set_filter(object, i, i < 2, i > 0 ? tags : NULL) == BM_OK);
    boxes[i].min[0] = boxes[i].min[1] = boxes[i].min[2] = 0;
    boxes[i].max[0] = boxes[i].max[1] = boxes[i].max[2] = 1;
  }
  bm_boxes four = view;
  four.count = 4;
  EXPECT(bm_update(object, four) == BM_OK);
  EXPECT(bm_get_pairs(object, &pairs) == BM_OK);
  /* 0-1: both in layer 1; 1-2, 1-3, 2-3: a common tag. */
  EXPECT(pairs.count == 2 && pairs.pairs[0].a == 0 && pairs.pairs[0].b == 2 &&
         pairs.pairs[1].a == 0 && pairs.pairs[1].b == 3);
  EXPECT_ERROR(BM_INVALID_ARGUMENT, bm_set_filter(object, 0, 32, NULL), "layer 32");
  bm_destroy(object);
}

static void test_changed(void) {
  bm_options options;
  bm_default_options(&options);
  bm_broadphase* object = NULL;
  bm_pairs pairs;
  EXPECT(bm_create(&options, &object) == BM_OK);
  move(2);
  EXPECT(bm_update(object, view) == BM_OK);
  const bm_box box = boxes[40];
  const uint32_t wrong = 41, right = 40;
  boxes[40].max[0] += 1;
  EXPECT_ERROR(BM_INVALID_ARGUMENT, bm_update_changed(object, view, &wrong, 1), "body 40");
  EXPECT_ERROR(BM_INVALID_ARGUMENT, bm_update_changed(object, view, NULL, 1), "changed");
  EXPECT_ERROR(BM_INVALID_ARGUMENT, bm_update_changed(object, view, NULL, 0), "body 40");
  EXPECT(bm_update_changed(object, view, &right, 1) == BM_OK);
  EXPECT(bm_get_pairs(object, &pairs) == BM_OK);
  EXPECT(are_right(pairs));
  boxes[40] = box;
  EXPECT(bm_update_changed(object, view, &right, 1) == BM_OK);
  EXPECT(bm_update_changed(object, view, NULL, 0) == BM_OK);
  bm_destroy(object);
}

static void test_states(void) {
  bm_broadphase* object = NULL;
  bm_pairs pairs;
  size_t size = 0, again = 0;
  EXPECT(bm_create(NULL, &object) == BM_OK);
  move(3);
  EXPECT(bm_update(object, view) == BM_OK);
  EXPECT_ERROR(BM_BUFFER_TOO_SMALL, bm_save(object, NULL, 0, &size), "smaller");
  void* const state = malloc(size);
  EXPECT(bm_save(object, state, size, &again) == BM_OK && again == size);
  move(4);
  EXPECT(bm_update(object, view) == BM_OK);
  EXPECT_ERROR(BM_INVALID_ARGUMENT, bm_restore(object, state, size - 1), "state");
  EXPECT_ERROR(BM_INVALID_ARGUMENT, bm_restore(object, NULL, size), "null");
  EXPECT(bm_restore(object, state, size) == BM_OK);
  move(3);
  EXPECT(bm_get_pairs(object, &pairs) == BM_OK);
  EXPECT(are_right(pairs));
  free(state);
  bm_destroy(object);
}

static void test_queries(void) {
  bm_broadphase* object = NULL;
  bm_body_results bodies;
  bm_hit_results hits;
  bm_neighbour_results neighbours;
  EXPECT(bm_create(NULL, &object) == BM_OK);
  EXPECT(bm_overlapping(object, NULL, 0, &bodies) == BM_OK && bodies.starts[0] == 0);
  move(6);
  EXPECT(bm_set_filter(object, 7, 3, NULL) == BM_OK);
  EXPECT(bm_update(object, view) == BM_OK);

  static bm_box_query about[kBodies];
  for (int i = 0; i < kBodies; ++i) {
    about[i].box = boxes[i];
    about[i].layers = i == 7 ? 1U << 3 : BM_ALL_LAYERS;
  }
  EXPECT(bm_overlapping(object, about, kBodies, &bodies) == BM_OK);
  for (uint32_t i = 0; i < kBodies; ++i) {
    size_t next = bodies.starts[i];
    for (uint32_t body = 0; body < kBodies; ++body) {
      if ((i == 7 && body != 7) || !overlap(&boxes[i], &boxes[body])) continue;
      EXPECT(next < bodies.starts[i + 1] && bodies.items[next] == body);
      ++next;
    }
    EXPECT(next == bodies.starts[i + 1]);
  }

  const bm_box_query wrong = {{{0, 0, 0}, {1, -1, 1}}, BM_ALL_LAYERS};
  EXPECT_ERROR(BM_INVALID_ARGUMENT, bm_overlapping(object, &wrong, 1, &bodies), "query 0: min");
  EXPECT_ERROR(BM_INVALID_ARGUMENT, bm_overlapping(object, NULL, 1, &bodies),
               "queries: must not be null");
  EXPECT_ERROR(BM_INVALID_ARGUMENT, bm_overlapping(object, about, 1, NULL),
               "results: must not be null");

  /* Through an edge of body 9, from below all bodies. */
  bm_cast_query ray = {{{0, 0, 0}, {0, 0, 0}}, {0, 0, 4}, INFINITY, BM_ALL_LAYERS};
  for (int axis = 0; axis < 3; ++axis) {
    ray.box.min[axis] = ray.box.max[axis] = axis == 2 ? -1 : boxes[9].min[axis];
  }
  EXPECT(bm_cast(object, &ray, 1, BM_HITS_ALL, &hits) == BM_OK);
  int found = 0;
  for (size_t i = 0; i < hits.starts[1]; ++i) {
    EXPECT(i == 0 || hits.items[i - 1].fraction <= hits.items[i].fraction);
    EXPECT(hits.items[i].fraction == (boxes[hits.items[i].body].min[2] + 1.0) / 4);
    found += hits.items[i].body == 9;
  }
  EXPECT(found == 1);
  const bm_hit first = hits.items[0];
  EXPECT(bm_cast(object, &ray, 1, BM_HITS_CLOSEST, &hits) == BM_OK);
  EXPECT(hits.starts[1] == 1 && hits.items[0].body == first.body);
  EXPECT_ERROR(BM_INVALID_ARGUMENT, bm_cast(object, &ray, 1, 2, &hits), "hits: invalid value 2");
  ray.direction[1] = NAN;
  EXPECT_ERROR(BM_INVALID_ARGUMENT, bm_cast(object, &ray, 1, 0, &hits), "direction");

  const bm_nearest_query point = {{-3, -4, 0}, kBodies + 1, INFINITY, 1U << 3}; /* body 7 */
  EXPECT(bm_nearest(object, &point, 1, &neighbours) == BM_OK);
  EXPECT(neighbours.starts[1] == 1 && neighbours.items[0].body == 7 &&
         neighbours.items[0].distance >= 5);
  EXPECT_ERROR(BM_INVALID_ARGUMENT, bm_nearest(NULL, &point, 1, &neighbours), "broadphase");
  bm_destroy(object);
}

static void test_jobs(void) {
  static bm_box many[50000];
  int jobs = 0;
  bm_options options;
  bm_default_options(&options);
  options.threads = 3;
  options.parallel_for = run_backwards;
  options.user = &jobs;
  for (int i = 0; i < 50000; ++i) {
    many[i].min[0] = many[i].min[1] = many[i].min[2] = (float)i;
    many[i].max[0] = many[i].max[1] = many[i].max[2] = (float)i + 1;
  }
  bm_broadphase* object = NULL;
  bm_pairs pairs;
  EXPECT(bm_create(&options, &object) == BM_OK);
  const bm_boxes all = {many[0].min, many[0].max, 50000, sizeof(bm_box)};
  EXPECT(bm_update(object, all) == BM_OK);
  EXPECT(bm_get_pairs(object, &pairs) == BM_OK);
  EXPECT(pairs.count == 49999);
  EXPECT(jobs > 1);
  bm_destroy(object);
}

static void test_errors(void) {
  bm_options options;
  bm_default_options(&options);
  options.method = 7;
  bm_broadphase* object = (bm_broadphase*)&options;
  EXPECT_ERROR(BM_INVALID_ARGUMENT, bm_create(&options, &object), "method: invalid value 7");
  EXPECT(object == NULL);
  EXPECT_ERROR(BM_INVALID_ARGUMENT, bm_create(NULL, NULL), "created: must not be null");
  EXPECT_ERROR(BM_INVALID_ARGUMENT, bm_update(NULL, view), "broadphase: must not be null");
  EXPECT(bm_create(NULL, &object) == BM_OK);
  move(5);
  boxes[9].max[2] = NAN;
  EXPECT_ERROR(BM_INVALID_ARGUMENT, bm_update(object, view), "body 9: z is NaN");
  EXPECT_ERROR(BM_INVALID_ARGUMENT, bm_get_pairs(object, NULL), "pairs: must not be null");
  bm_boxes none = {NULL, NULL, 3, sizeof(bm_box)};
  EXPECT_ERROR(BM_INVALID_ARGUMENT, bm_update(object, none), "null");
  bm_destroy(object);
}

int main(void) {
  EXPECT(bm_last_error()[0] == '\0');
  test_pairs();
  test_events();
  test_filters();
  test_changed();
  test_states();
  test_queries();
  test_jobs();
  test_errors();
  printf("%s\n", failures == 0 ? "passed" : "FAILED");
  return failures == 0 ? 0 : 1;
}
