// Hierarchical grid: cells of edge 2^l units on level l. A body lives on the finest level on which
// it reaches from the cell of its lower corner no farther than into the next one, and there in that
// one cell. Whatever meets it on its own level is then in a neighbouring cell; whatever meets it
// and is larger, in one of the 27 cells around it on a coarser level.
//
// Coordinates become integers by a monotone function, so rounding and clamping cost no pair: if
// a.low <= b.high, then so are their cells.
//
// Cells wrap around into a table of 2^bits buckets, neighbours along x beside each other. What is in
// a bucket may thus be from another cell; a pair counts only in the cell it was looked for.

#define LEVELS 21u

/// How coordinates become cells, and cells buckets.
typedef struct {
  float4 scale;   // units per length
  float4 origin;  // lower corner of all boxes, in units
  uint4 bits;     // of the bucket's number, per axis
} Grid;

static inline uint3 unit_of(float4 corner, Grid grid) {
  const float4 units = corner * grid.scale - grid.origin;
  return convert_uint3(clamp(units.xyz, 0.0f, (float)((1 << (LEVELS - 1)) - 1)));
}

static inline uint level_of(uint3 low, uint3 high) {
  for (uint level = 0;; ++level) {
    const uint3 reach = (high >> level) - (low >> level);
    if ((reach.x <= 1) & (reach.y <= 1) & (reach.z <= 1)) return level;
  }
}

/// The bucket at the start of a row of cells along x.
static inline uint row_of(uint y, uint z, uint level, Grid grid) {
  const uint y_part = y & ((1u << grid.bits.y) - 1);
  // Levels begin at different places.
  const uint z_part = (z + 37 * level) & ((1u << grid.bits.z) - 1);
  return (z_part << grid.bits.y | y_part) << grid.bits.x;
}

__kernel void make_keys(__global const Box* boxes, const uint n, const Grid grid,
                        __global uint* keys, __global uint* bodies,
                        volatile __global uint* used_levels) {
  uint used = 0;
  FOR_EACH_BODY(i, n) {
    const uint3 low = unit_of(boxes[i].low, grid);
    const uint level = level_of(low, unit_of(boxes[i].high, grid));
    const uint3 cell = low >> level;
    keys[i] = row_of(cell.y, cell.z, level, grid) | (cell.x & ((1u << grid.bits.x) - 1));
    bodies[i] = i;
    used |= 1u << level;
  }
  const uint known = *used_levels;  // race: bits are only ever added; an older set does, too
  if ((known & used) != used) atomic_or(used_levels, used);
}

/// Puts the boxes into the buckets' order, and notes where each bucket starts.
__kernel void gather(__global const Box* boxes, __global const uint* keys,
                     __global const uint* bodies, const uint n, const uint buckets,
                     __global Box* sorted, __global uint* starts) {
  FOR_EACH_BODY(i, n) {
    sorted[i] = boxes[bodies[i]];
    for (uint bucket = i == 0 ? 0 : keys[i - 1] + 1; bucket <= keys[i]; ++bucket) {
      starts[bucket] = i;
    }
    if (i + 1 == n) {
      for (uint bucket = keys[i] + 1; bucket <= buckets; ++bucket) starts[bucket] = n;
    }
  }
}

/// The body whose partners are looked for.
typedef struct {
  float4 low;
  float4 high;
  uint position;
  uint number;
} Seeker;

typedef struct {
  __global const Box* sorted;
  __global const uint* bodies;
  __global const uint* starts;
  Grid grid;
} Cells;

/// Cells [first.x, last_x] of the row at first.y, first.z.
typedef struct {
  uint3 first;
  uint last_x;
  uint level;
  bool own;  // the row starts with the seeker's own cell
} Row;

static inline void search_buckets(const Seeker* seeker, const Cells* cells, const Row* row,
                                  uint begin, uint end, Sink* sink) {
  for (uint j = begin; j < end; ++j) {
    const Box other = cells->sorted[j];
    if (!meet(seeker->low, seeker->high, other.low, other.high)) continue;
    const uint3 low = unit_of(other.low, cells->grid);
    if (level_of(low, unit_of(other.high, cells->grid)) != row->level) continue;
    const uint3 cell = low >> row->level;
    if ((cell.y != row->first.y) | (cell.z != row->first.z) | (cell.x < row->first.x) |
        (cell.x > row->last_x)) {
      continue;
    }
    // In its own cell the earlier of the two finds the pair.
    if (row->own && cell.x == row->first.x && j <= seeker->position) continue;
    report(sink, seeker->number, cells->bodies[j]);
  }
}

static inline void search_row(const Seeker* seeker, const Cells* cells, const Row* row,
                              Sink* sink) {
  const uint size = 1u << cells->grid.bits.x;
  const uint count = min(row->last_x - row->first.x + 1, size);
  const uint from = count == size ? 0 : row->first.x & (size - 1);
  const uint before_wrap = min(count, size - from);
  __global const uint* starts =
      cells->starts + row_of(row->first.y, row->first.z, row->level, cells->grid);
  search_buckets(seeker, cells, row, starts[from], starts[from + before_wrap], sink);
  if (before_wrap < count) {
    search_buckets(seeker, cells, row, starts[0], starts[count - before_wrap], sink);
  }
}

/// Half of the neighbours, the own cell among them: the other half finds this body.
static inline void search_own_level(const Seeker* seeker, const Cells* cells, uint3 cell,
                                    uint level, Sink* sink) {
  Row row;
  row.level = level;
  row.last_x = cell.x + 1;
  row.first = cell;
  row.own = true;
  search_row(seeker, cells, &row, sink);
  row.own = false;
  row.first.x = max(cell.x, 1u) - 1;
  row.first.y = cell.y + 1;
  search_row(seeker, cells, &row, sink);
  row.first.z = cell.z + 1;
  for (row.first.y = max(cell.y, 1u) - 1; row.first.y <= cell.y + 1; ++row.first.y) {
    search_row(seeker, cells, &row, sink);
  }
}

static inline void search_coarser_level(const Seeker* seeker, const Cells* cells, uint3 low,
                                        uint3 high, uint level, Sink* sink) {
  const uint3 first = max(low >> level, (uint3)(1)) - (uint3)(1);
  const uint3 last = high >> level;
  Row row;
  row.level = level;
  row.last_x = last.x;
  row.own = false;
  row.first = first;
  for (row.first.z = first.z; row.first.z <= last.z; ++row.first.z) {
    for (row.first.y = first.y; row.first.y <= last.y; ++row.first.y) {
      search_row(seeker, cells, &row, sink);
    }
  }
}

__kernel void search(__global const Box* sorted, __global const uint* bodies,
                     __global const uint* starts, const uint n, const Grid grid,
                     __global const uint* used_levels, __global uint2* pairs,
                     volatile __global uint* count, const uint capacity) {
  MAKE_SINK(sink)
  Cells cells;
  cells.sorted = sorted;
  cells.bodies = bodies;
  cells.starts = starts;
  cells.grid = grid;
  const uint used = *used_levels;
  FOR_EACH_BODY(i, n) {
    Seeker seeker;
    seeker.low = sorted[i].low;
    seeker.high = sorted[i].high;
    seeker.position = i;
    seeker.number = bodies[i];
    const uint3 low = unit_of(seeker.low, grid);
    const uint3 high = unit_of(seeker.high, grid);
    const uint own = level_of(low, high);
    search_own_level(&seeker, &cells, low >> own, own, &sink);
    for (uint level = own + 1; level < LEVELS && used >> level != 0; ++level) {
      if ((used >> level & 1) != 0) {
        search_coarser_level(&seeker, &cells, low, high, level, &sink);
      }
    }
  }
  flush(&sink);
}
