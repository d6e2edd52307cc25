/* An algorithm in C: sort and sweep along one axis (Ericson 2005, 7.5).
 *
 *   cc -O2 -shared -fPIC -I PREFIX/include sweep.c -o sweep.so
 *   broadmark --headless freefall --plugin ./sweep.so --algorithm c-sweep */
#include <broadmark_plugin.h>
#include <stdlib.h>
#include <string.h>

typedef struct entry {
  float min, max; /* on the sweep axis */
  uint32_t body;
} entry;

typedef struct sweep {
  int axis;
  broadmark_box world;
  broadmark_box* boxes;
  entry* entries;
  uint32_t count;
  broadmark_pair* pairs;
  size_t pair_count, pair_capacity;
} sweep;

static void destroy(void* self) {
  sweep* const s = self;
  free(s->boxes);
  free(s->entries);
  free(s->pairs);
  free(s);
}

static void update_objects(void* self, const broadmark_frame* frame) {
  sweep* const s = self;
  s->count = frame->bodies;
  memcpy(s->boxes, frame->boxes, s->count * sizeof(broadmark_box));
}

static void* create(const broadmark_scene* scene, const broadmark_frame* initial) {
  sweep* const s = calloc(1, sizeof(sweep));
  if (s == NULL) return NULL;
  s->axis = (int)scene->parameters[0];
  s->world = scene->world;
  s->boxes = aligned_alloc(16, (scene->bodies + 1) * sizeof(broadmark_box));
  s->entries = malloc((scene->bodies + 1) * sizeof(entry));
  if (s->boxes == NULL || s->entries == NULL) {
    destroy(s);
    return NULL;
  }
  update_objects(s, initial);
  return s;
}

static int by_min(const void* a, const void* b) {
  const float x = ((const entry*)a)->min, y = ((const entry*)b)->min;
  return (x > y) - (x < y);
}

static void update_structures(void* self) {
  sweep* const s = self;
  for (uint32_t i = 0; i < s->count; ++i) {
    s->entries[i] = (entry){s->boxes[i].min[s->axis], s->boxes[i].max[s->axis], i};
  }
  qsort(s->entries, s->count, sizeof(entry), by_min);
}

static int overlap(const broadmark_box* a, const broadmark_box* b) {
  for (int axis = 0; axis < 3; ++axis) {
    if (a->min[axis] > b->max[axis] || b->min[axis] > a->max[axis]) return 0;
  }
  return 1;
}

static int add(sweep* s, uint32_t a, uint32_t b) {
  if (s->pair_count == s->pair_capacity) {
    const size_t capacity = 2 * s->pair_capacity + 64;
    broadmark_pair* const pairs = realloc(s->pairs, capacity * sizeof(broadmark_pair));
    if (pairs == NULL) return 1;
    s->pairs = pairs;
    s->pair_capacity = capacity;
  }
  s->pairs[s->pair_count++] = a < b ? (broadmark_pair){a, b} : (broadmark_pair){b, a};
  return 0;
}

static int32_t search_overlaps(void* self, broadmark_answer* answer) {
  sweep* const s = self;
  s->pair_count = 0;
  for (uint32_t i = 0; i < s->count; ++i) {
    const entry first = s->entries[i];
    for (uint32_t j = i + 1; j < s->count && s->entries[j].min <= first.max; ++j) {
      const uint32_t a = first.body, b = s->entries[j].body;
      if (overlap(&s->boxes[a], &s->boxes[b]) && add(s, a, b) != 0) return 1;
    }
  }
  answer->pairs = (broadmark_pairs){s->pairs, s->pair_count};
  return 0;
}

static void draw(void* self, const broadmark_drawing* drawing) {
  const sweep* const s = self;
  float to[3] = {s->world.min[0], s->world.min[1], s->world.min[2]};
  to[s->axis] = s->world.max[s->axis];
  drawing->line(drawing->context, s->world.min, to);
}

static const char* error(void* self) {
  (void)self;
  return "out of memory";
}

static const broadmark_parameter parameters[] = {
    {"axis", "the axis that is swept: 0, 1 or 2", 0, 0, 2, 1}};

static const broadmark_algorithm algorithms[] = {{
    .id = "c-sweep",
    .family = "C sweep",
    .summary = "sort and sweep along one axis, written in C",
    .principle = "sorting",
    .time = "O(n log n + w), w pairs that overlap on the axis",
    .space = "O(n + k)",
    .source = "Ericson 2005, 7.5",
    .traits = BROADMARK_COMPACTED,
    .parameters = parameters,
    .parameter_count = 1,
    .create = create,
    .destroy = destroy,
    .update_objects = update_objects,
    .update_structures = update_structures,
    .search_overlaps = search_overlaps,
    .draw = draw,
    .error = error,
}};

const broadmark_plugin* broadmark_c_plugin(void) {
  static const broadmark_plugin plugin = {BROADMARK_PLUGIN_VERSION, 1, sizeof(broadmark_algorithm),
                                          algorithms};
  return &plugin;
}
