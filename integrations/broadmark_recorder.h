/* Records what a running engine gives to its broad phase and the pairs that it gets, to be audited:
 * NAME.broadmark and NAME.csv. C99 or C++, no dependency: copy this file. The document
 * docs/integrations.md of Broadmark has an introduction, docs/recordings.md the format.
 *
 *   broadmark_recorder recorder;
 *   unsigned layer;
 *   broadmark_record_begin(&recorder, "session", 1000);
 *   layer = broadmark_record_layer(&recorder, 1, 1);
 *
 *   // A frame: the bodies that are present and the pairs, in any order.
 *   broadmark_record_box(&recorder, body, min, max, layer, BROADMARK_NO_TAG);
 *   broadmark_record_pair(&recorder, body, other_body);
 *   broadmark_record_frame(&recorder);
 *
 *   broadmark_record_end(&recorder);
 *
 * Functions return 1, or 0 after an error, which `error` names and which ends the recording. Both
 * files are complete after each frame, so a crash of the engine leaves the frames before it. (The
 * index of frames is rewritten each time: the files suit tens of thousands of frames.)
 *
 * SPDX-License-Identifier: MIT
 * Copyright (c) 2026 The Broadmark authors
 */
#ifndef BROADMARK_RECORDER_H
#define BROADMARK_RECORDER_H

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef __cplusplus
extern "C" {
#endif

#define BROADMARK_NO_TAG 0xFFFFFFFFu

typedef struct bmr_slot {
  uint64_t body;
  float box[6], last_box[6];          /* min, max: of this frame, and of the previous one */
  uint32_t filter[4], last_filter[4]; /* layer, tags */
  int is_used, is_present;            /* used: by a body present in this frame or the last one */
} bmr_slot;

typedef struct bmr_frame { /* in the recording's index */
  uint64_t offset;
  uint32_t changed, key;
  uint64_t hash[2];
} bmr_frame;

/* All members but the first two are private. */
typedef struct broadmark_recorder {
  char error[256]; /* empty: none */
  int either;      /* set after broadmark_record_begin(): see broadmark_record_layer() */
  FILE *box_file, *pair_file;
  char name[64];
  bmr_slot* slots;
  uint32_t slot_count, free_count, table_size;
  uint32_t *free_slots, *table; /* the table: slot + 1 by hash of the body; 0: empty */
  uint32_t layer_count;
  uint64_t categories[32], masks[32];
  uint64_t* pairs; /* of this frame: two bodies each */
  size_t pair_count, pair_capacity;
  float world[6];
  int is_fixed, some_absent, has_tags, filter_changes; /* fixed: the number of bodies */
  uint32_t frame_count, frame_capacity;
  uint32_t* filter_counts; /* bodies with a changed filter, by frame */
  bmr_frame* index;        /* by frame */
  fpos_t end;              /* of the frames in the file */
  uint64_t end_offset;
  size_t groups_end; /* in `head`: start, header, groups, which precede frame 0; then the index */
  unsigned char *head, *block; /* `block`: a frame */
} broadmark_recorder;

enum { BMR_HEADER_BYTES = 8192 - 16 }; /* with 16 bytes before it, a multiple of 32 */

static inline int bmr_fail(broadmark_recorder* r, const char* what) {
  if (r->error[0] != 0) return 0;
  snprintf(r->error, sizeof r->error, "frame %lu: %.200s", (unsigned long)r->frame_count, what);
  return 0;
}

/* XXH3-128 of Y. Collet (xxhash.com), for 0 bytes, a multiple of 32, or more than 240. */

static const unsigned char bmr_secret[192] = {
    0xb8, 0xfe, 0x6c, 0x39, 0x23, 0xa4, 0x4b, 0xbe, 0x7c, 0x01, 0x81, 0x2c, 0xf7, 0x21, 0xad, 0x1c,
    0xde, 0xd4, 0x6d, 0xe9, 0x83, 0x90, 0x97, 0xdb, 0x72, 0x40, 0xa4, 0xa4, 0xb7, 0xb3, 0x67, 0x1f,
    0xcb, 0x79, 0xe6, 0x4e, 0xcc, 0xc0, 0xe5, 0x78, 0x82, 0x5a, 0xd0, 0x7d, 0xcc, 0xff, 0x72, 0x21,
    0xb8, 0x08, 0x46, 0x74, 0xf7, 0x43, 0x24, 0x8e, 0xe0, 0x35, 0x90, 0xe6, 0x81, 0x3a, 0x26, 0x4c,
    0x3c, 0x28, 0x52, 0xbb, 0x91, 0xc3, 0x00, 0xcb, 0x88, 0xd0, 0x65, 0x8b, 0x1b, 0x53, 0x2e, 0xa3,
    0x71, 0x64, 0x48, 0x97, 0xa2, 0x0d, 0xf9, 0x4e, 0x38, 0x19, 0xef, 0x46, 0xa9, 0xde, 0xac, 0xd8,
    0xa8, 0xfa, 0x76, 0x3f, 0xe3, 0x9c, 0x34, 0x3f, 0xf9, 0xdc, 0xbb, 0xc7, 0xc7, 0x0b, 0x4f, 0x1d,
    0x8a, 0x51, 0xe0, 0x4b, 0xcd, 0xb4, 0x59, 0x31, 0xc8, 0x9f, 0x7e, 0xc9, 0xd9, 0x78, 0x73, 0x64,
    0xea, 0xc5, 0xac, 0x83, 0x34, 0xd3, 0xeb, 0xc3, 0xc5, 0x81, 0xa0, 0xff, 0xfa, 0x13, 0x63, 0xeb,
    0x17, 0x0d, 0xdd, 0x51, 0xb7, 0xf0, 0xda, 0x49, 0xd3, 0x16, 0x55, 0x26, 0x29, 0xd4, 0x68, 0x9e,
    0x2b, 0x16, 0xbe, 0x58, 0x7d, 0x47, 0xa1, 0xfc, 0x8f, 0xf8, 0xb8, 0xd1, 0x7a, 0xd0, 0x31, 0xce,
    0x45, 0xcb, 0x3a, 0x8f, 0x95, 0x16, 0x04, 0x28, 0xaf, 0xd7, 0xfb, 0xca, 0xbb, 0x4b, 0x40, 0x7e};

#define BMR_PRIME_1 0x9E3779B185EBCA87u
#define BMR_PRIME_2 0xC2B2AE3D27D4EB4Fu

static inline uint64_t bmr_word(const unsigned char* bytes) {
  uint64_t word;
  memcpy(&word, bytes, sizeof word);
  return word;
}

static inline uint64_t bmr_fold(uint64_t a, uint64_t b) { /* the halves of the product, xored */
  const uint64_t low = (a & 0xFFFFFFFFu) * (b & 0xFFFFFFFFu), high = (a >> 32) * (b >> 32);
  const uint64_t c = (a >> 32) * (b & 0xFFFFFFFFu), d = (a & 0xFFFFFFFFu) * (b >> 32);
  const uint64_t cross = (low >> 32) + (c & 0xFFFFFFFFu) + d;
  return ((cross << 32) | (low & 0xFFFFFFFFu)) ^ (high + (c >> 32) + (cross >> 32));
}

static inline uint64_t bmr_avalanche(uint64_t h) {
  h = (h ^ (h >> 37)) * 0x165667919E3779F9u;
  return h ^ (h >> 32);
}

static inline uint64_t bmr_mix(const unsigned char* in, const unsigned char* secret) {
  return bmr_fold(bmr_word(in) ^ bmr_word(secret), bmr_word(in + 8) ^ bmr_word(secret + 8));
}

static inline void bmr_mix2(uint64_t h[2], const unsigned char* a, const unsigned char* b,
                            const unsigned char* secret) {
  h[0] = (h[0] + bmr_mix(a, secret)) ^ (bmr_word(b) + bmr_word(b + 8));
  h[1] = (h[1] + bmr_mix(b, secret + 16)) ^ (bmr_word(a) + bmr_word(a + 8));
}

static inline void bmr_accumulate(uint64_t* sums, const unsigned char* in,
                                  const unsigned char* secret) {
  int i;
  for (i = 0; i < 8; ++i) {
    const uint64_t word = bmr_word(in + 8 * i);
    const uint64_t key = word ^ bmr_word(secret + 8 * i);
    sums[i ^ 1] += word;
    sums[i] += (key & 0xFFFFFFFFu) * (key >> 32);
  }
}

static inline uint64_t bmr_merge(const uint64_t* sums, const unsigned char* secret,
                                 uint64_t start) {
  int i;
  for (i = 0; i < 4; ++i) {
    start += bmr_fold(sums[2 * i] ^ bmr_word(secret + 16 * i),
                      sums[2 * i + 1] ^ bmr_word(secret + 16 * i + 8));
  }
  return bmr_avalanche(start);
}

static inline void bmr_hash(const unsigned char* in, size_t size, uint64_t hash[2]) {
  const unsigned char* const secret = bmr_secret;
  const unsigned char* const end = in + size;
  uint64_t h[2];
  size_t i;
  h[0] = size * BMR_PRIME_1;
  h[1] = 0;
  if (size == 0) {
    hash[0] = 0x6001C324468D497Fu;
    hash[1] = 0x99AA06D3014798D8u;
    return;
  }
  if (size > 240) {
    uint64_t sums[8] = {0xC2B2AE3Du,         0x9E3779B185EBCA87u, 0xC2B2AE3D27D4EB4Fu,
                        0x165667B19E3779F9u, 0x85EBCA77C2B2AE63u, 0x85EBCA77u,
                        0x27D4EB2F165667C5u, 0x9E3779B1u};
    const size_t stripes = (size - 1) / 64;
    int k;
    for (i = 0; i < stripes; ++i) {
      bmr_accumulate(sums, in + 64 * i, secret + 8 * (i % 16));
      for (k = 0; i % 16 == 15 && k < 8; ++k) {
        sums[k] ^= (sums[k] >> 47) ^ bmr_word(secret + 128 + 8 * k);
        sums[k] *= 0x9E3779B1u;
      }
    }
    bmr_accumulate(sums, end - 64, secret + 121);
    hash[0] = bmr_merge(sums, secret + 11, h[0]);
    hash[1] = bmr_merge(sums, secret + 117, ~(size * BMR_PRIME_2));
    return;
  }
  if (size > 128) {
    for (i = 0; i < 4; ++i) bmr_mix2(h, in + 32 * i, in + 32 * i + 16, secret + 32 * i);
    h[0] = bmr_avalanche(h[0]);
    h[1] = bmr_avalanche(h[1]);
    for (; i < size / 32; ++i) {
      bmr_mix2(h, in + 32 * i, in + 32 * i + 16, secret + 3 + 32 * (i - 4));
    }
    bmr_mix2(h, end - 16, end - 32, secret + 103);
  } else {
    for (i = (size - 1) / 32 + 1; i-- > 0;) {
      bmr_mix2(h, in + 16 * i, end - 16 * (i + 1), secret + 32 * i);
    }
  }
  hash[0] = bmr_avalanche(h[0] + h[1]);
  hash[1] = 0 - bmr_avalanche(h[0] * BMR_PRIME_1 + h[1] * 0x85EBCA77C2B2AE63u + size * BMR_PRIME_2);
}

/* Bodies and their slots: the ids in the recording. */

/* The body's entry of the table, or the empty one for it. */
static inline uint32_t* bmr_entry(const broadmark_recorder* r, uint64_t body) {
  uint64_t at = bmr_avalanche(body * BMR_PRIME_1);
  for (;; ++at) {
    uint32_t* const entry = &r->table[at & (r->table_size - 1)];
    if (*entry == 0 || r->slots[*entry - 1].body == body) return entry;
  }
}

static inline void bmr_fill_table(broadmark_recorder* r) {
  uint32_t i;
  memset(r->table, 0, r->table_size * sizeof *r->table);
  for (i = 0; i < r->slot_count; ++i) {
    if (r->slots[i].is_used) *bmr_entry(r, r->slots[i].body) = i + 1;
  }
}

/* realloc(), which leaves the memory as it is after an error. */
static inline void* bmr_resized(broadmark_recorder* r, void* memory, size_t size) {
  void* const resized = realloc(memory, size);
  if (resized == NULL) bmr_fail(r, "not enough memory");
  return resized == NULL ? memory : resized;
}

static inline int bmr_add_slots(broadmark_recorder* r, uint32_t count) {
  uint32_t table_size = 16, i;
  int k;
  while (table_size < 2 * (uint64_t)count) table_size *= 2;
  r->slots = (bmr_slot*)bmr_resized(r, r->slots, count * sizeof *r->slots);
  r->free_slots = (uint32_t*)bmr_resized(r, r->free_slots, count * sizeof *r->free_slots);
  r->table = (uint32_t*)bmr_resized(r, r->table, table_size * sizeof *r->table);
  r->block = (unsigned char*)bmr_resized(r, r->block, count * (size_t)48 + 128);
  if (r->error[0] != 0) return 0;
  for (i = r->slot_count; i < count; ++i) {
    bmr_slot* const slot = &r->slots[i];
    memset(slot, 0, sizeof *slot);
    for (k = 1; k < 4; ++k) slot->filter[k] = BROADMARK_NO_TAG;
    r->free_slots[r->free_count++] = count - 1 - (i - r->slot_count); /* the lowest one is last */
  }
  r->slot_count = count;
  r->table_size = table_size;
  bmr_fill_table(r);
  return 1;
}

/* A bound as a float. It is rounded into the box, so that rounding alone makes no pair missed. */
static inline float bmr_bound(double bound, int is_min) {
  const float limit = 3.4028234e38f;
  float rounded = bound > limit ? limit : bound < -limit ? -limit : (float)bound;
  if (is_min && rounded < bound && rounded < limit) rounded = nextafterf(rounded, limit);
  if (!is_min && rounded > bound && rounded > -limit) rounded = nextafterf(rounded, -limit);
  return rounded;
}

/* The parts of a recording. */

static inline size_t bmr_aligned(size_t size) { return (size + 31) / 32 * 32; }

/* The box of a slot, or its layer and tags; null if unchanged since the last frame. */
static inline const void* bmr_changed_row(const broadmark_recorder* r, uint32_t i, int is_filter) {
  const bmr_slot* const s = &r->slots[i];
  if (is_filter) return memcmp(s->filter, s->last_filter, sizeof s->filter) ? s->filter : NULL;
  if (r->frame_count == 0) return s->box;
  return memcmp(s->box, s->last_box, sizeof s->box) ? s->box : NULL;
}

/* Writes the ids of changed bodies, unless they are all, and their rows. Frame 0 holds all boxes
 * and states no changes. Returns the size. */
static inline size_t bmr_write_rows(const broadmark_recorder* r, unsigned char* out, int is_filter,
                                    uint32_t* changed) {
  const size_t row_bytes = is_filter ? sizeof r->slots->filter : sizeof r->slots->box;
  size_t size, rows = 0;
  uint32_t i;
  for (i = 0; i < r->slot_count; ++i) rows += bmr_changed_row(r, i, is_filter) != NULL;
  *changed = r->frame_count == 0 ? 0 : (uint32_t)rows;
  size = rows < r->slot_count ? bmr_aligned(4 * rows) : 0;
  memset(out, 0, size + bmr_aligned(row_bytes * rows));
  for (i = 0, rows = 0; i < r->slot_count; ++i) {
    const void* const row = bmr_changed_row(r, i, is_filter);
    if (row == NULL) continue;
    if (size > 0) memcpy(out + 4 * rows, &i, sizeof i);
    memcpy(out + size + row_bytes * rows++, row, row_bytes);
  }
  return size + bmr_aligned(row_bytes * rows);
}

/* Writes the header's text, padded with spaces. Numbers have a point in every locale. */
static inline void bmr_write_header(const broadmark_recorder* r, char* out) {
  const size_t room = BMR_HEADER_BYTES;
  size_t size = 0;
  uint32_t a, b;
  const char* comma = "";
  int i;
  size += (size_t)snprintf(
      out, room,
      "{\"schema\": \"broadmark-recording/2%s\", \"name\": \"%s\", \"object_type\": \"Bodies\", "
      "\"objects\": %lu, \"frames\": %lu, \"all_present\": %s, \"groups\": [\"layers\"%s], "
      "\"source\": null, \"scene_parameters\": null, \"colliding_layers\": [",
      r->filter_changes ? ".1" : "", r->name, (unsigned long)r->slot_count,
      (unsigned long)r->frame_count, r->some_absent ? "false" : "true",
      r->has_tags ? ", \"tags\"" : "");
  for (a = 0; a < r->layer_count; ++a) {
    for (b = a; b < r->layer_count; ++b) {
      const int one = (r->categories[a] & r->masks[b]) != 0;
      const int other = (r->categories[b] & r->masks[a]) != 0;
      if (r->either ? !one && !other : !one || !other) continue;
      size += (size_t)snprintf(out + size, room - size, "%s[%lu,%lu]", comma, (unsigned long)a,
                               (unsigned long)b);
      comma = ",";
    }
  }
  for (i = 0; i < 6; ++i) {
    char number[32], *c;
    const double bound = r->world[0] <= r->world[3] ? (double)r->world[i] : 0;
    snprintf(number, sizeof number, "%.9g", bound);
    for (c = number; *c != 0; ++c) *c = *c == ',' ? '.' : *c;
    size += (size_t)snprintf(out + size, room - size, "%s%s",
                             i == 0   ? "], \"world\": [["
                             : i == 3 ? "], ["
                                      : ", ",
                             number);
  }
  size += (size_t)snprintf(out + size, room - size, "]]}");
  memset(out + size, ' ', room - size - 1);
  out[room - 1] = '\n';
}

static inline unsigned long bmr_id(const broadmark_recorder* r, uint64_t body) {
  const uint32_t entry = *bmr_entry(r, body);
  return entry != 0 && r->slots[entry - 1].is_present ? entry - 1 : 0xFFFFFFFFu;
}

static inline int bmr_write_pairs(broadmark_recorder* r) {
  size_t i;
  for (i = 0; i < r->pair_count; ++i) {
    if (fprintf(r->pair_file, "%lu,%lu,%lu\n", (unsigned long)r->frame_count,
                bmr_id(r, r->pairs[2 * i]), bmr_id(r, r->pairs[2 * i + 1])) < 0) {
      break;
    }
  }
  if (i < r->pair_count || fflush(r->pair_file) != 0) return bmr_fail(r, "cannot write the pairs");
  r->pair_count = 0;
  return 1;
}

/* Lays out what precedes frame 0, for the first time in frame 0. */
static inline int bmr_begin_file(broadmark_recorder* r) {
  const size_t begin = 16 + BMR_HEADER_BYTES, n = r->slot_count;
  unsigned char* tags;
  uint32_t i;
  r->groups_end = begin + bmr_aligned(n) + (r->has_tags ? bmr_aligned(12 * n) : 0);
  r->head = (unsigned char*)bmr_resized(r, r->head, r->groups_end);
  if (r->error[0] != 0) return 0;
  memset(r->head, 0, r->groups_end);
  tags = r->head + begin + bmr_aligned(n);
  for (i = 0; i < n; ++i) {
    bmr_slot* const s = &r->slots[i];
    r->head[begin + i] = (unsigned char)s->filter[0];
    if (r->has_tags) memcpy(tags + 12 * (size_t)i, s->filter + 1, 12);
    memcpy(s->last_filter, s->filter, sizeof s->filter);
  }
  r->end_offset = r->groups_end;
  if (fwrite(r->head, 1, r->groups_end, r->box_file) != r->groups_end ||
      fgetpos(r->box_file, &r->end) != 0) {
    return bmr_fail(r, "cannot write the boxes");
  }
  return 1;
}

/* Appends the frame, then writes the index behind it and the header: the file is complete again. */
static inline int bmr_write_frame(broadmark_recorder* r) {
  const uint64_t header_bytes = BMR_HEADER_BYTES;
  bmr_frame* const entry = &r->index[r->frame_count];
  uint64_t trailer[4];
  uint32_t* const filter_changed = &r->filter_counts[r->frame_count];
  size_t size, counts = 0, head_bytes;
  size = bmr_write_rows(r, r->block, 0, &entry->changed);
  size += bmr_write_rows(r, r->block + size, 1, filter_changed);
  if (*filter_changed > 0) r->filter_changes = 1;
  entry->offset = r->end_offset;
  entry->key = 0;
  bmr_hash(r->block, size, entry->hash);
  r->end_offset += size;

  if (r->filter_changes) counts = bmr_aligned(4 * (size_t)(r->frame_count + 1));
  head_bytes = r->groups_end + counts + sizeof(bmr_frame) * (r->frame_count + 1);
  r->head = (unsigned char*)bmr_resized(r, r->head, head_bytes + sizeof trailer);
  if (r->error[0] != 0) return 0;
  memcpy(r->head, "BRDMARK2", 8);
  memcpy(r->head + 8, &header_bytes, 8);
  bmr_write_header(r, (char*)r->head + 16);
  memset(r->head + r->groups_end, 0, counts);
  if (counts > 0)
    memcpy(r->head + r->groups_end, r->filter_counts, 4 * (size_t)(r->frame_count + 1));
  memcpy(r->head + r->groups_end + counts, r->index, sizeof(bmr_frame) * (r->frame_count + 1));
  trailer[0] = r->end_offset + counts;
  bmr_hash(r->head, head_bytes, trailer + 1);
  memcpy(trailer + 3, "BRDMARK2", 8);
  memcpy(r->head + head_bytes, trailer, sizeof trailer);

  head_bytes += sizeof trailer - r->groups_end; /* of the part behind the frames */
  if (fsetpos(r->box_file, &r->end) != 0 || fwrite(r->block, 1, size, r->box_file) != size ||
      fgetpos(r->box_file, &r->end) != 0 ||
      fwrite(r->head + r->groups_end, 1, head_bytes, r->box_file) != head_bytes ||
      fseek(r->box_file, 0, SEEK_SET) != 0 ||
      fwrite(r->head, 1, 16 + BMR_HEADER_BYTES, r->box_file) != 16 + BMR_HEADER_BYTES ||
      fflush(r->box_file) != 0) {
    return bmr_fail(r, "cannot write the boxes");
  }
  return 1;
}

/* The interface. */

/* Begins NAME.broadmark and NAME.csv, which must not exist. `max_bodies` is the largest number of
 * bodies present at the same time, and those that come in a frame, since a body that is gone leaves
 * its id to others a frame later. 0: all bodies are present in all frames. */
static inline int broadmark_record_begin(broadmark_recorder* r, const char* name,
                                         uint32_t max_bodies) {
  const char* c;
  const uint16_t one = 1;
  size_t length = 0;
  int i;
  memset(r, 0, sizeof *r);
  for (i = 0; i < 6; ++i) r->world[i] = i < 3 ? INFINITY : -INFINITY;
  if (*(const unsigned char*)&one == 0) return bmr_fail(r, "the processor is not little-endian");
  for (c = name; *c != 0; ++c) { /* the last part of the path names the recording */
    const int is_plain = (*c >= '0' && *c <= '9') || ((*c | 32) >= 'a' && (*c | 32) <= 'z');
    if (*c == '/' || *c == '\\') {
      length = 0;
    } else if (length + 1 < sizeof r->name) {
      r->name[length++] = is_plain ? *c : '_';
    }
    r->name[length] = 0;
  }
  for (i = 0; i < 2; ++i) {
    char path[1024];
    FILE* file;
    if ((size_t)snprintf(path, sizeof path, "%s.%s", name, i == 0 ? "broadmark" : "csv") >=
        sizeof path) {
      return bmr_fail(r, "the name of the files is too long");
    }
    file = fopen(path, "rb");
    if (file != NULL) {
      fclose(file);
      return bmr_fail(r, "a file of this name exists: choose another one");
    }
    file = fopen(path, "wb");
    if (file == NULL) return bmr_fail(r, "the files cannot be written: is there such a folder?");
    *(i == 0 ? &r->box_file : &r->pair_file) = file;
  }
  if (fputs("frame,a,b\n", r->pair_file) < 0) return bmr_fail(r, "cannot write the pairs");
  r->is_fixed = max_bodies == 0;
  return bmr_add_slots(r, r->is_fixed ? 16 : max_bodies);
}

/* The layer of bodies of these categories that collide with those in the mask: a pair is two bodies
 * of which each one's categories are in the other's mask, or with `either`, at least one's are. At
 * most 32 combinations. Returns 32 after an error. */
static inline unsigned broadmark_record_layer(broadmark_recorder* r, uint64_t category,
                                              uint64_t mask) {
  uint32_t i;
  for (i = 0; i < r->layer_count; ++i) {
    if (r->categories[i] == category && r->masks[i] == mask) return i;
  }
  if (i == 32) {
    bmr_fail(r, "more than 32 combinations of category and mask");
    return i;
  }
  r->categories[i] = category;
  r->masks[i] = mask;
  return r->layer_count++;
}

/* A body that is present in this frame. `body` is any number that identifies it, such as its
 * address; `layer` is from broadmark_record_layer(), also of other bodies. Bodies with a common tag
 * are no pair. */
static inline int broadmark_record_box(broadmark_recorder* r, uint64_t body, const double min[3],
                                       const double max[3], unsigned layer, uint32_t tag) {
  bmr_slot* slot;
  uint32_t* entry;
  int i;
  if (r->error[0] != 0) return 0;
  if (layer >= r->layer_count) return bmr_fail(r, "the layer is not from broadmark_record_layer()");
  for (i = 0; i < 3; ++i) {
    if (!(min[i] <= max[i]))
      return bmr_fail(r, "a box is not a number, or its min is over its max");
  }
  entry = bmr_entry(r, body);
  if (*entry == 0 && r->free_count == 0) {
    if (r->frame_count > 0) return bmr_fail(r, "there are more bodies than max_bodies");
    if (!bmr_add_slots(r, 2 * r->slot_count)) return 0;
    entry = bmr_entry(r, body);
  }
  if (*entry == 0) *entry = r->free_slots[--r->free_count] + 1;
  slot = &r->slots[*entry - 1];
  if (slot->is_present) return bmr_fail(r, "a body is recorded twice");
  slot->body = body;
  slot->is_used = slot->is_present = 1;
  slot->filter[0] = layer;
  slot->filter[1] = tag;
  if (tag != BROADMARK_NO_TAG && r->frame_count == 0) r->has_tags = 1;
  for (i = 0; i < 3; ++i) {
    slot->box[i] = bmr_bound(min[i], 1);
    slot->box[i + 3] = bmr_bound(max[i], 0);
    if (slot->box[i] > slot->box[i + 3]) slot->box[i] = slot->box[i + 3]; /* thinner than a float */
    /* The bounds of half-spaces are no part of the world. */
    if (min[i] > -1e15 && slot->box[i] < r->world[i]) r->world[i] = slot->box[i];
    if (max[i] < 1e15 && slot->box[i + 3] > r->world[i + 3]) r->world[i + 3] = slot->box[i + 3];
  }
  return 1;
}

/* A pair of this frame. If no box has been recorded for one of its bodies, the body gets an id that
 * does not exist, and the audit reports an impossible pair. */
static inline int broadmark_record_pair(broadmark_recorder* r, uint64_t a, uint64_t b) {
  if (r->error[0] != 0) return 0;
  if (r->pair_count == r->pair_capacity) {
    const size_t capacity = 2 * r->pair_capacity + 1024;
    r->pairs = (uint64_t*)bmr_resized(r, r->pairs, capacity * 2 * sizeof *r->pairs);
    if (r->error[0] != 0) return 0;
    r->pair_capacity = capacity;
  }
  r->pairs[2 * r->pair_count] = a;
  r->pairs[2 * r->pair_count++ + 1] = b;
  return 1;
}

/* Ends the frame, and writes it. */
static inline int broadmark_record_frame(broadmark_recorder* r) {
  int k, some_left = 0;
  uint32_t i;
  if (r->error[0] != 0) return 0;
  if (r->frame_count == 0 && r->is_fixed) {
    const uint32_t used = r->slot_count - r->free_count;
    r->slot_count = used > 0 ? used : 1;
    r->free_count = r->slot_count - used;
    r->free_slots[0] = 0;
  }
  if (r->frame_count == r->frame_capacity) {
    r->frame_capacity = 2 * r->frame_capacity + 64;
    r->index = (bmr_frame*)bmr_resized(r, r->index, r->frame_capacity * sizeof *r->index);
    r->filter_counts =
        (uint32_t*)bmr_resized(r, r->filter_counts, r->frame_capacity * sizeof *r->filter_counts);
    if (r->error[0] != 0) return 0;
  }
  for (i = 0; i < r->slot_count; ++i) {
    bmr_slot* const s = &r->slots[i];
    for (k = 0; !s->is_present && k < 6; ++k) s->box[k] = k < 3 ? INFINITY : -INFINITY;
    if (!s->is_present) r->some_absent = 1;
  }
  if (r->frame_count == 0 && !bmr_begin_file(r)) return 0;
  /* Pairs first: a log that is ahead of its recording is refused, one that is behind would look as
   * if pairs were missed. */
  if (!bmr_write_pairs(r) || !bmr_write_frame(r)) return 0;
  ++r->frame_count;
  for (i = 0; i < r->slot_count; ++i) {
    bmr_slot* const s = &r->slots[i];
    memcpy(s->last_box, s->box, sizeof s->box);
    memcpy(s->last_filter, s->filter, sizeof s->filter);
    if (s->is_used && !s->is_present) {
      s->is_used = 0;
      r->free_slots[r->free_count++] = i;
      some_left = 1;
    }
    s->is_present = 0;
  }
  if (some_left) bmr_fill_table(r);
  return 1;
}

/* Closes the files and frees the memory, also after an error. */
static inline int broadmark_record_end(broadmark_recorder* r) {
  if (r->box_file != NULL && fclose(r->box_file) != 0) bmr_fail(r, "cannot write the boxes");
  if (r->pair_file != NULL && fclose(r->pair_file) != 0) bmr_fail(r, "cannot write the pairs");
  r->box_file = r->pair_file = NULL;
  free(r->slots);
  free(r->free_slots);
  free(r->table);
  free(r->pairs);
  free(r->filter_counts);
  free(r->index);
  free(r->head);
  free(r->block);
  r->slots = NULL;
  r->pairs = NULL;
  r->free_slots = r->table = r->filter_counts = NULL;
  r->index = NULL;
  r->head = r->block = NULL;
  return r->error[0] == 0;
}

#ifdef __cplusplus
}
#endif

#endif
