/* The C interface of broadmark/broadphase.hpp, which says more. Example: examples/game_loop.c.
 *
 * Functions that can fail return a bm_status; bm_last_error() then says what is wrong. None of them
 * throws. One thread at a time may use an object: a second one gets BM_MISUSE. */
#ifndef BROADMARK_BROADPHASE_H
#define BROADMARK_BROADPHASE_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum bm_status {
  BM_OK = 0,
  BM_INVALID_ARGUMENT = 1, /* the call is at fault, and has changed nothing */
  BM_MISUSE = 2,           /* not allowed now */
  BM_OUT_OF_MEMORY = 3,
  BM_FAILED = 4, /* no threads, an exception from the job system, ... */
  BM_BUFFER_TOO_SMALL = 5
} bm_status;

/* The message of this thread's last call that failed: one line; "" if none has. Valid until the
 * next call on this thread. */
const char* bm_last_error(void);

typedef struct bm_box {
  float min[3];
  float max[3];
} bm_box;

/* Two bodies, a < b. */
typedef struct bm_pair {
  uint32_t a;
  uint32_t b;
} bm_pair;

typedef struct bm_pairs {
  const bm_pair* pairs;
  size_t count;
} bm_pairs;

/* The caller's boxes: body i has three floats at `min` and three at `max`, both `stride` bytes
 * further for each body. An absent body has min = INFINITY and max = -INFINITY on every axis. */
typedef struct bm_boxes {
  const float* min;
  const float* max;
  size_t count;
  size_t stride;
} bm_boxes;

enum { BM_METHOD_TIDE = 0, BM_METHOD_COLUMNS = 1 };
enum { BM_ANSWER_PAIRS = 0, BM_ANSWER_EVENTS = 1 };
enum { BM_ORDER_SORTED = 0, BM_ORDER_ANY = 1 };
enum { BM_CHANGES_VERIFIED = 0, BM_CHANGES_TRUSTED = 1 };
enum { BM_ISA_BEST = 0, BM_ISA_SCALAR, BM_ISA_SSE2, BM_ISA_NEON, BM_ISA_AVX2, BM_ISA_AVX512 };

enum { BM_HITS_CLOSEST = 0, BM_HITS_ALL = 1 };

#define BM_NO_TAG UINT32_C(0xFFFFFFFF)
#define BM_ALL_LAYERS UINT32_C(0xFFFFFFFF)

/* Calls job(context, i) exactly once for each i below `jobs`, in any order, at the same time or one
 * after another, and returns when all calls have returned. `user`: bm_options.user. */
typedef void bm_parallel_for(void* user, int jobs, void (*job)(void* context, int i),
                             void* context);

/* To be filled by bm_default_options(), and then changed. */
typedef struct bm_options {
  int method;
  int answer;
  int order;
  int changes;
  int threads;
  int instruction_set;
  float margin;
  uint32_t collides[32];         /* bit b of row a: layers a and b collide; symmetric */
  bm_parallel_for* parallel_for; /* null: own threads */
  void* user;
} bm_options;

void bm_default_options(bm_options* options);

typedef struct bm_broadphase bm_broadphase;

/* Null options: the defaults. */
bm_status bm_create(const bm_options* options, bm_broadphase** created);
/* Null is allowed. */
void bm_destroy(bm_broadphase* broadphase);

bm_status bm_update(bm_broadphase* broadphase, bm_boxes boxes);
bm_status bm_update_changed(bm_broadphase* broadphase, bm_boxes boxes, const uint32_t* changed,
                            size_t count);

/* Null tags: none. */
bm_status bm_set_filter(bm_broadphase* broadphase, uint32_t body, uint32_t layer,
                        const uint32_t tags[3]);

/* The answer of the last update; valid until the next one or bm_restore(). */
bm_status bm_get_pairs(const bm_broadphase* broadphase, bm_pairs* pairs);
bm_status bm_get_events(const bm_broadphase* broadphase, bm_pairs* began, bm_pairs* ended);

/* Queries find bodies of the given layers: bit b for layer b. */
typedef struct bm_box_query {
  bm_box box;
  uint32_t layers;
} bm_box_query;

/* A box that moves along `direction`, up to `max_fraction` times as far; INFINITY: no limit. A ray
 * is the cast of a point: min = max. */
typedef struct bm_cast_query {
  bm_box box;
  float direction[3];
  float max_fraction;
  uint32_t layers;
} bm_cast_query;

/* The `count` bodies nearest to a point, up to `max_distance` away; INFINITY: no limit. */
typedef struct bm_nearest_query {
  float point[3];
  uint32_t count;
  float max_distance;
  uint32_t layers;
} bm_nearest_query;

/* The boxes begin to overlap when the cast's has moved by `fraction` times its direction. */
typedef struct bm_hit {
  double fraction;
  uint32_t body;
} bm_hit;

typedef struct bm_neighbour {
  double distance;
  uint32_t body;
} bm_neighbour;

/* The answer to query i is items[starts[i]] to items[starts[i + 1] - 1]. Valid until the next call
 * of the same function. */
typedef struct bm_body_results {
  const size_t* starts;
  const uint32_t* items;
} bm_body_results;

typedef struct bm_hit_results {
  const size_t* starts;
  const bm_hit* items;
} bm_hit_results;

typedef struct bm_neighbour_results {
  const size_t* starts;
  const bm_neighbour* items;
} bm_neighbour_results;

/* Batches of queries about the boxes of the last update. */
bm_status bm_overlapping(bm_broadphase* broadphase, const bm_box_query* queries, size_t count,
                         bm_body_results* results);
bm_status bm_cast(bm_broadphase* broadphase, const bm_cast_query* casts, size_t count, int hits,
                  bm_hit_results* results);
bm_status bm_nearest(bm_broadphase* broadphase, const bm_nearest_query* queries, size_t count,
                     bm_neighbour_results* results);

/* Writes the state to `bytes`, of `capacity` bytes, and its size to `size`, which alone is done if
 * that is more than `capacity`: BM_BUFFER_TOO_SMALL. */
bm_status bm_save(const bm_broadphase* broadphase, void* bytes, size_t capacity, size_t* size);
bm_status bm_restore(bm_broadphase* broadphase, const void* bytes, size_t size);

#ifdef __cplusplus
}
#endif

#endif
