// Hierarchical grid: bodies on level l extend over at most 2^l units, and cells have edges of 2^(l
// + edge) units. A body is stored on the finest possible level, in the one cell of its lower
// corner. A body that overlaps a box has its lower corner between 2^l units before the box and the
// box's end: in two cells per axis, or three if cells are as small as the units.
//
// Coordinates are quantised by a monotonic function, so rounding and clamping lose no pair: if
// a.low <= b.high, then so are their units.
//
// Cells wrap around into a table of 2^bits buckets, with neighbours along x contiguous. So a bucket
// may also hold bodies of other cells; a pair counts only in the queried cell.

#define LEVELS 21u

/// The mapping of coordinates to cells, and of cells to buckets.
typedef struct {
  float4 scale;   // units per length
  float4 origin;  // lower corner of all boxes, in units
  uint4 bits;     // of the bucket's number, per axis
  uint4 edge;     // cells on level l have edges of 2^(l + edge) units
} Grid;

static inline uint3 unit_of(float4 corner, Grid grid) {
  const float4 units = corner * grid.scale - grid.origin;
  return convert_uint3(clamp(units.xyz, 0.0f, (float)((1 << (LEVELS - 1)) - 1)));
}

static inline uint level_of(uint3 low, uint3 high) {
  const uint3 edges = high - low;
  return 32 - clz(max(max(edges.x, edges.y), max(edges.z, 1u)) - 1);
}

static inline uint3 cell_of(uint3 low, uint level, Grid grid) {
  return low >> (level + grid.edge.xyz);
}

/// The bucket at the start of a row of cells along x.
static inline uint row_of(uint y, uint z, uint level, Grid grid) {
  const uint y_part = y & ((1u << grid.bits.y) - 1);
  // Levels have different offsets.
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
    const uint3 cell = cell_of(low, level, grid);
    keys[i] = row_of(cell.y, cell.z, level, grid) | (cell.x & ((1u << grid.bits.x) - 1));
    bodies[i] = i;
    used |= 1u << level;
  }
  const uint known = *used_levels;  // race: bits are only added; an outdated set is correct, too
  if ((known & used) != used) atomic_or(used_levels, used);
}

/// Permutes the boxes into the buckets' order, and stores the start of each bucket.
__kernel void gather(__global const Box* boxes, __global const uint* keys,
                     __global const uint* bodies, const uint n, const uint buckets,
                     const uint stride, __global float* sorted, __global uint* starts) {
  FOR_EACH_BODY(i, n + PADDING) {
    if (i >= n) {
      put_sorted(sorted, stride, i, (float4)(INFINITY), (float4)(-INFINITY));
      continue;
    }
    PREFETCH(boxes + bodies[min(i + PREFETCHED, n - 1)]);
    const Box box = boxes[bodies[i]];
    put_sorted(sorted, stride, i, box.low, box.high);
    for (uint bucket = i == 0 ? 0 : keys[i - 1] + 1; bucket <= keys[i]; ++bucket) {
      starts[bucket] = i;
    }
    if (i + 1 == n) {
      for (uint bucket = keys[i] + 1; bucket <= buckets; ++bucket) starts[bucket] = n;
    }
  }
}

/// The bodies in the order of their buckets.
typedef struct {
  __global const float* sorted;
  uint stride;
  __global const uint* bodies;
  __global const uint* starts;
  Grid grid;
} Cells;

static inline Box box_at(const Cells* cells, uint i) {
  __global const float* first = cells->sorted + i;
  const uint stride = cells->stride;
  Box box;
  box.low = (float4)(first[0], first[2 * stride], first[4 * stride], 0);
  box.high = (float4)(first[stride], first[3 * stride], first[5 * stride], 0);
  return box;
}

/// A query on one level: for the bodies in the cells from `first` to `last`, from index `earliest`
/// on, that overlap `box`.
typedef struct {
  Box box;
  uint number;
  uint level;
  uint3 first;
  uint3 last;
  uint earliest;
} Search;

/// Whether body j is in the cells [search->first.x, search->last.x] of a row.
static inline int in_row(const Search* search, const Cells* cells, uint y, uint z, uint j) {
  const Box box = box_at(cells, j);
  const uint3 low = unit_of(box.low, cells->grid);
  const uint level = level_of(low, unit_of(box.high, cells->grid));
  const uint3 cell = cell_of(low, level, cells->grid);
  return (level == search->level) & (cell.y == y) & (cell.z == z) & (cell.x >= search->first.x) &
         (cell.x <= search->last.x);
}

/// `exact`: a bucket is one cell, of this level.
ALWAYS_INLINE void search_row(const Search* search, const Cells* cells, uint y, uint z, int exact,
                              Sink* sink) {
  const Box box = search->box;
  const uint stride = cells->stride;
  const uint size = 1u << cells->grid.bits.x;
  const uint count = min(search->last.x - search->first.x + 1, size);
  __global const uint* starts = cells->starts + row_of(y, z, search->level, cells->grid);
  for (uint done = 0; done < count;) {  // repeats if the row wraps around
    const uint from = (search->first.x + done) & (size - 1);
    const uint part = exact ? count : min(count - done, size - from);
    done += part;
    const uint end = starts[from + part];
    for (uint block = max(starts[from], search->earliest); block < end; block += LANES) {
      __global const float* bounds = cells->sorted + block;
      const uint hits = bits_of(reach(bounds, stride, box.low.x, box.high.x) &
                                reach(bounds + 2 * stride, stride, box.low.y, box.high.y) &
                                reach(bounds + 4 * stride, stride, box.low.z, box.high.z));
      FOR_EACH_HIT(j, hits, block, end) {
        if (exact || in_row(search, cells, y, z, j)) report(sink, search->number, cells->bodies[j]);
      }
    }
    if (exact) break;
  }
}

/// Finds the bodies that overlap body i, with corners in the units `low` and `high`, on one level.
/// `ordered`: buckets are in the order of cells.
ALWAYS_INLINE void search_level(const Cells* cells, uint i, Box box, uint3 low, uint3 high,
                                uint level, int is_own, int ordered, int exact, Sink* sink) {
  const uint3 back = (uint3)(1u << level);  // a vector: oclgrind's max() takes no scalar beside one
  Search search;
  search.box = box;
  search.number = cells->bodies[i];
  search.level = level;
  search.first = cell_of(max(low, back) - back, level, cells->grid);
  search.last = cell_of(high, level, cells->grid);
  // On their own level, the earlier of two bodies finds the later one.
  search.earliest = is_own ? i + 1 : 0;
  // If ordered, all bodies in rows before its own row are earlier.
  const uint3 begin = is_own && ordered ? cell_of(low, level, cells->grid) : search.first;
  for (uint z = begin.z; z <= search.last.z; ++z) {
    for (uint y = z == begin.z ? begin.y : search.first.y; y <= search.last.y; ++y) {
      search_row(&search, cells, y, z, exact, sink);
    }
  }
}

/// `wraps`: cells share buckets.
__kernel void search(__global const float* sorted, const uint stride, __global const uint* bodies,
                     __global const uint* starts, const uint n, const Grid grid, const uint wraps,
                     __global const uint* used_levels, __global uint2* pairs,
                     volatile __global uint* count, const uint capacity) {
  MAKE_SINK(sink)
  Cells cells;
  cells.sorted = sorted;
  cells.stride = stride;
  cells.bodies = bodies;
  cells.starts = starts;
  cells.grid = grid;
  const uint used = *used_levels;
  const int exact = used == 1 && !wraps;
  FOR_EACH_BODY(i, n) {
    const Box box = box_at(&cells, i);
    const uint3 low = unit_of(box.low, grid);
    const uint3 high = unit_of(box.high, grid);
    if (exact) {  // bodies of similar size: the same, but much faster with these constants
      search_level(&cells, i, box, low, high, 0, 1, 1, 1, &sink);
      continue;
    }
    const uint own = level_of(low, high);
    for (uint level = own; used >> level != 0; ++level) {
      if ((used >> level & 1) == 0) continue;
      // Coarser levels have other offsets in the table, and may wrap around.
      search_level(&cells, i, box, low, high, level, level == own, level == 0 && !wraps, 0, &sink);
    }
  }
  flush(&sink);
}
