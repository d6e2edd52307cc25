/* Algorithms in any language that can make a shared library: `broadmark --plugin FILE` loads it,
 * and treats its algorithms as its own (checks, torture, duels, the inspector). The library needs
 * this header alone, and works with later releases of the program. Examples: plugins/examples.
 *
 * The library exports one function:
 *
 *   const broadmark_plugin* broadmark_c_plugin(void);
 *
 * Per run the program calls, from one thread: create; search_overlaps, if the answer is events;
 * then for every frame update_objects, clean_cache, update_structures, search_overlaps, each timed;
 * finally destroy. Functions marked optional may be null. Pointers that a function receives are
 * valid during the call, `collides` and `filter` until the next update_objects. A crash, a hang or
 * an exception ends the run with that result.
 *
 * C++ algorithms with vectors, threads and adapters of the program: broadmark/plugin.h. */
#ifndef BROADMARK_PLUGIN_H
#define BROADMARK_PLUGIN_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The version of these structures. Later versions only add members at their ends. */
#define BROADMARK_PLUGIN_VERSION 1

/* Boxes are closed: two that touch overlap. Bounds are finite, in world units; the fourth component
 * is 0. An absent body has min = INFINITY and max = -INFINITY on every axis. Arrays of boxes are
 * aligned to 16 bytes. */
typedef struct broadmark_box {
  float min[4];
  float max[4];
} broadmark_box;

/* Two bodies, by index in the frame; a < b. */
typedef struct broadmark_pair {
  uint32_t a;
  uint32_t b;
} broadmark_pair;

/* An array of pairs; may be null if there are none. */
typedef struct broadmark_pairs {
  const broadmark_pair* pairs;
  size_t count;
} broadmark_pairs;

/* A parameter, set by `--param NAME=VALUE`. Names differ, and the default is in the range. */
typedef struct broadmark_parameter {
  const char* name;   /* snake_case */
  const char* doc;    /* one sentence, with the unit */
  double value;       /* the default */
  double min;         /* inclusive */
  double max;         /* inclusive */
  int32_t is_integer; /* 1: whole numbers only */
} broadmark_parameter;

/* Properties of the scene, before its first frame. */
typedef struct broadmark_scene {
  uint32_t bodies;          /* the largest number in a frame */
  uint32_t frames;          /* without the initial pose */
  broadmark_box world;      /* bodies may protrude a little */
  uint32_t threads;         /* to use at most */
  int32_t events;           /* 1: the answer is events (BROADMARK_EVENTS) */
  const double* parameters; /* values, in the order of broadmark_algorithm.parameters */
} broadmark_scene;

/* The boxes of one moment. */
typedef struct broadmark_frame {
  uint32_t index;             /* 0: the initial pose */
  uint32_t bodies;            /* boxes; varies only with BROADMARK_COMPACTED */
  const broadmark_box* boxes; /* by body */
  const uint32_t*
      changed; /* bodies that moved, appeared or vanished since the last frame, ascending */
  size_t changed_count; /* 0 in the initial pose */
  /* With BROADMARK_CHANGING_WORLDS: whether an overlap of two different bodies counts. Null: of
   * all. */
  int32_t (*collides)(const void* filter, uint32_t a, uint32_t b);
  const void* filter; /* the first argument of `collides` */
} broadmark_frame;

/* Each pair once, in any order. The arrays belong to the algorithm, and remain valid until its next
 * update_objects or destroy. */
typedef struct broadmark_answer {
  broadmark_pairs pairs; /* events: those that began, for the initial pose all */
  broadmark_pairs ended; /* events only */
} broadmark_answer;

/* Receives the drawing of a structure: boxes, and lines between two points. `level`: depth in a
 * tree, else 0. */
typedef struct broadmark_drawing {
  void* context; /* the first argument of both functions */
  void (*box)(void* context, const broadmark_box* box, int32_t level);
  void (*line)(void* context, const float from[3], const float to[3]);
} broadmark_drawing;

/* Traits: what tests, runs and lists rely on. */
enum {
  BROADMARK_PARALLEL = 1,    /* uses broadmark_scene.threads */
  BROADMARK_INCREMENTAL = 2, /* retains pairs or a structure between frames */
  BROADMARK_EVENTS = 4,      /* answers events, if asked to */
  /* Worlds in which bodies come and go, or some pairs do not count; without either they are
     skipped. */
  BROADMARK_CHANGING_WORLDS = 8, /* handles absent bodies and `collides` itself */
  BROADMARK_COMPACTED = 16 /* any number of bodies in each frame: the program removes absent bodies
                              and unwanted pairs. Not with BROADMARK_EVENTS. */
};

/* An algorithm. Its strings and parameters remain valid as long as the library is loaded; `self` is
 * what create() returned. */
typedef struct broadmark_algorithm {
  const char* id;      /* "my-sweep": lower-case letters, digits and -_. */
  const char* family;  /* "My Sweep" */
  const char* summary; /* one sentence */
  /* Optional, for lists: "sorting", "O(n + k)" twice, "Ericson 2005, 7.5". */
  const char* principle;
  const char* time;
  const char* space;
  const char* source;
  uint32_t traits;     /* BROADMARK_PARALLEL | ... */
  uint32_t max_bodies; /* 0: any number */
  const broadmark_parameter* parameters;
  size_t parameter_count; /* 0: none */
  /* Optional. An extra pair is allowed if the two boxes overlap once each is enlarged by this much
   * on every side, in world units. Depends on the parameters alone; may be called at any time. */
  float (*margin)(const double* parameters);
  /* A new instance with all structures for the initial pose; null: it failed. */
  void* (*create)(const broadmark_scene* scene, const broadmark_frame* initial);
  void (*destroy)(void* self); /* not called if create() failed */
  /* Phase 1: copies the new boxes, or those that changed. */
  void (*update_objects)(void* self, const broadmark_frame* frame);
  void (*clean_cache)(void* self);       /* phase 2, optional: drops the last answer */
  void (*update_structures)(void* self); /* phase 3, optional: brings the structure up to date */
  /* Phase 4: finds the answer: sets the members of `answer`, which are null and 0 before. Returns
   * 0; anything else: it failed. */
  int32_t (*search_overlaps)(void* self, broadmark_answer* answer);
  void (*draw)(void* self, const broadmark_drawing* drawing); /* optional */
  /* Optional: why the last call failed, in one line, copied. `self` is null after create. */
  const char* (*error)(void* self);
} broadmark_algorithm;

/* What the library exports. */
typedef struct broadmark_plugin {
  uint32_t version;                      /* BROADMARK_PLUGIN_VERSION */
  uint32_t algorithm_count;              /* at least 1 */
  size_t algorithm_size;                 /* sizeof(broadmark_algorithm) */
  const broadmark_algorithm* algorithms; /* copied when the library is loaded */
} broadmark_plugin;

#define BROADMARK_PLUGIN_EXPORT __attribute__((visibility("default")))

/* To be defined by the library, which keeps what it returns. Called at loading, perhaps several
 * times; null is refused. */
BROADMARK_PLUGIN_EXPORT const broadmark_plugin* broadmark_c_plugin(void);

#ifdef __cplusplus
}
#endif
#endif
