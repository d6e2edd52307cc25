/* The C interface of broadmark/broadphase.hpp, which says more. Example: examples/game_loop.c;
 * costs and limits: docs/embedding.md.
 *
 * Functions that can fail return a bm_status; bm_last_error() then says what is wrong. None of them
 * throws. One thread at a time may use an object: a second one gets BM_MISUSE. Any of them may run
 * out of memory, and returns BM_INVALID_ARGUMENT for a null pointer unless null is allowed; what
 * else it returns is said below. Results point into the object.
 *
 * If bm_update(), bm_update_changed() or bm_restore() fails by BM_OUT_OF_MEMORY or BM_FAILED, or by
 * BM_MISUSE because the job system did not run each job exactly once, only bm_restore() and
 * bm_destroy() are allowed afterwards, and earlier results are invalid: updates, filters, queries,
 * answers and bm_save() return BM_MISUSE. */
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
  BM_MISUSE = 2,           /* not allowed now; or the job system breaks its contract */
  BM_OUT_OF_MEMORY = 3,
  BM_FAILED = 4,          /* no threads, an exception from the job system, ... */
  BM_BUFFER_TOO_SMALL = 5 /* only by bm_save() */
} bm_status;

/* The message of this thread's last call that failed: one line; "" if none has. Calls that succeed
 * leave it. Valid until the next call on this thread. */
const char* bm_last_error(void);

/* Closed: boxes that touch overlap. Bounds are finite and in order on every axis. */
typedef struct bm_box {
  float min[3];
  float max[3];
} bm_box;

/* Two bodies, a < b. */
typedef struct bm_pair {
  uint32_t a;
  uint32_t b;
} bm_pair;

/* An array of pairs, which belongs to the object. */
typedef struct bm_pairs {
  const bm_pair* pairs;
  size_t count;
} bm_pairs;

/* The caller's boxes: body i has three floats at `min` and three at `max`, both `stride` bytes
 * further for each body. An absent body has min = INFINITY and max = -INFINITY on every axis. They
 * are read during the call alone. */
typedef struct bm_boxes {
  const float* min;
  const float* max;
  size_t count;  /* at most 2^29 - 1 */
  size_t stride; /* at least 3 * sizeof(float) */
} bm_boxes;

/* The values of bm_options and of bm_cast(); broadphase.hpp explains them by the same names. */
enum { BM_METHOD_TIDE = 0, BM_METHOD_COLUMNS = 1 };
enum { BM_ANSWER_PAIRS = 0, BM_ANSWER_EVENTS = 1 };
enum { BM_ORDER_SORTED = 0, BM_ORDER_ANY = 1 };
enum { BM_CHANGES_VERIFIED = 0, BM_CHANGES_TRUSTED = 1 };
enum { BM_ISA_BEST = 0, BM_ISA_SCALAR, BM_ISA_SSE2, BM_ISA_NEON, BM_ISA_AVX2, BM_ISA_AVX512 };

enum { BM_HITS_CLOSEST = 0, BM_HITS_ALL = 1 };

/* An unused tag, which no body shares. */
#define BM_NO_TAG UINT32_C(0xFFFFFFFF)
/* For queries: bodies of any layer. */
#define BM_ALL_LAYERS UINT32_C(0xFFFFFFFF)

/* Calls job(context, i) exactly once for each i below `jobs`, in any order, at the same time or one
 * after another, and returns when all calls have returned. `user`: bm_options.user. Must not use
 * the object. */
typedef void bm_parallel_for(void* user, int jobs, void (*job)(void* context, int i),
                             void* context);

/* To be filled by bm_default_options(), and then changed. */
typedef struct bm_options {
  int method;                    /* BM_METHOD_... */
  int answer;                    /* BM_ANSWER_... */
  int order;                     /* BM_ORDER_... */
  int changes;                   /* BM_CHANGES_... */
  int threads;                   /* 1 to 1024, the caller's included */
  int instruction_set;           /* BM_ISA_... */
  float margin;                  /* finite, not negative: boxes are enlarged by it on every side */
  uint32_t collides[32];         /* bit b of row a: layers a and b collide; symmetric */
  bm_parallel_for* parallel_for; /* null: own threads */
  void* user;                    /* passed to parallel_for */
} bm_options;

/* Null is allowed, and ignored. */
void bm_default_options(bm_options* options);

/* The broad phase of a world of bodies, whose ids are the indices of their boxes. */
typedef struct bm_broadphase bm_broadphase;

/* Creates an object without bodies, to be destroyed by the caller; if that fails, `*created` is
 * null. Null options: the defaults. BM_INVALID_ARGUMENT: an option out of its range, an instruction
 * set that this processor lacks, or `collides` is not symmetric. Threads are started by the first
 * update. */
bm_status bm_create(const bm_options* options, bm_broadphase** created);
/* Waits for own threads to end. Null is allowed. */
void bm_destroy(bm_broadphase* broadphase);

/* Takes the boxes of all bodies, and finds the answer. O(count), and the search.
 * BM_INVALID_ARGUMENT: NaN, infinite bounds, min > max, too many bodies, or a stride of less than
 * three floats. BM_MISUSE, BM_FAILED: see above. */
bm_status bm_update(bm_broadphase* broadphase, bm_boxes boxes);
/* The same if the caller knows the ids of the bodies that changed. BM_INVALID_ARGUMENT: also an id
 * that does not exist; with BM_CHANGES_VERIFIED, a changed body that is not listed. With
 * BM_CHANGES_TRUSTED only the boxes of listed and new bodies are read. */
bm_status bm_update_changed(bm_broadphase* broadphase, bm_boxes boxes, const uint32_t* changed,
                            size_t count);

/* Sets a body's layer and tags, from the next update on, which then costs at least as much as the
 * first. Null tags: none. BM_INVALID_ARGUMENT: a layer above 31, or an id above 2^29 - 2. */
bm_status bm_set_filter(bm_broadphase* broadphase, uint32_t body, uint32_t layer,
                        const uint32_t tags[3]);

/* The answer of the last update; valid until the next one or bm_restore(). O(1). BM_MISUSE: the
 * other answer was chosen, or another call is under way. */
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

/* A body found by a bm_nearest_query. */
typedef struct bm_neighbour {
  double distance; /* from the point to the body's box; 0 inside of it */
  uint32_t body;
} bm_neighbour;

/* The answer to query i is items[starts[i]] to items[starts[i + 1] - 1]; `starts` has one entry
 * more than there are queries. Valid until the next call of the same function, or bm_destroy(). */
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

/* Batches of queries about the boxes of the last update. The first one builds a tree, later ones
 * refit it. BM_INVALID_ARGUMENT: NaN, min > max, negative limits, infinite numbers other than
 * limits, or no such value of `hits`. BM_MISUSE, BM_FAILED: as for updates, but a query that fails
 * changes nothing but the results of its function. */
bm_status bm_overlapping(bm_broadphase* broadphase, const bm_box_query* queries, size_t count,
                         bm_body_results* results);
bm_status bm_cast(bm_broadphase* broadphase, const bm_cast_query* casts, size_t count, int hits,
                  bm_hit_results* results);
bm_status bm_nearest(bm_broadphase* broadphase, const bm_nearest_query* queries, size_t count,
                     bm_neighbour_results* results);

/* Writes the state to `bytes`, of `capacity` bytes, and its size to `size`, which alone is done if
 * that is more than `capacity`: BM_BUFFER_TOO_SMALL; then `bytes` may be null. O(bodies).
 * BM_MISUSE: also between bm_set_filter() and an update. */
bm_status bm_save(const bm_broadphase* broadphase, void* bytes, size_t capacity, size_t* size);
/* Back to a saved state, also after a failed update. Costs as much as an update to the saved boxes.
 * BM_INVALID_ARGUMENT: the bytes are not such a state, or one of another answer, margin or
 * `collides`; this changes nothing. */
bm_status bm_restore(bm_broadphase* broadphase, const void* bytes, size_t size);

#ifdef __cplusplus
}
#endif

#endif
