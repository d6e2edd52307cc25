// Linear bounding volume hierarchy: bodies in the order of their centres along a Morton curve; a
// binary radix tree over that order, built for all nodes at once; one traversal per body.
//
//   make_keys, sort  order of the bodies
//   gather           leaves: the boxes in that order
//   merge_ranges     a launch per level: the unions of 4, 16, 64 ... leaves, behind the leaves
//   build            each node by itself: its children, and their boxes from the ranges
//   search
//
// A node covers a range of leaves, so its box depends on no other node: no work group waits for
// another one's writes, which OpenCL 1.2 cannot order within a kernel.
//
// Inner node k stores its two children's boxes contiguously, in one cache line. In a child's box,
// low.w is its index (leaves have the highest bit set) and high.w the last leaf below it.

#define LEAF 0x80000000u

typedef struct {
  Box child[2];
} Node;

/// Spreads ten bits out to every third position.
static inline uint spread(uint x) {
  x = (x | x << 16) & 0x030000ffu;
  x = (x | x << 8) & 0x0300f00fu;
  x = (x | x << 4) & 0x030c30c3u;
  x = (x | x << 2) & 0x09249249u;
  return x;
}

__kernel void make_keys(__global const Box* boxes, const uint n, const float4 low,
                        const float4 scale, __global uint* keys, __global uint* bodies) {
  FOR_EACH_BODY(i, n) {
    const float4 centre = 0.5f * boxes[i].low + 0.5f * boxes[i].high;
    const float4 cell = clamp((centre - low) * scale, 0.0f, 1023.0f);
    keys[i] = spread((uint)cell.x) | spread((uint)cell.y) << 1 | spread((uint)cell.z) << 2;
    bodies[i] = i;
  }
}

/// Length of the common prefix of two leaves' keys; equal keys are extended by their indices. -1
/// for no such leaf.
static inline int common_bits(__global const uint* keys, int n, int i, int j) {
  if (j < 0 || j >= n) return -1;
  const uint difference = keys[i] ^ keys[j];
  return difference != 0 ? (int)clz(difference) : 32 + (int)clz((uint)(i ^ j));
}

/// Permutes the boxes into the leaves' order.
__kernel void gather(__global const Box* boxes, __global const uint* bodies, const uint n,
                     __global Box* leaves) {
  FOR_EACH_BODY(i, n) {
    PREFETCH(boxes + bodies[min(i + PREFETCHED, n - 1)]);
    leaves[i] = boxes[bodies[i]];
  }
}

/// Ranges of one level per range of the next level.
#define ARITY 4u

static inline void extend(Box* box, __global const Box* by) {
  box->low = fmin(box->low, by->low);
  box->high = fmax(box->high, by->high);
}

/// Merges the `count` ranges of a level, at `ranges` + `first`, to those of the next, behind them.
__kernel void merge_ranges(__global Box* ranges, const uint first, const uint count,
                           const uint merged_count) {
  FOR_EACH_BODY(i, merged_count) {
    Box box = ranges[first + ARITY * i];
    for (uint k = ARITY * i + 1; k < min(ARITY * (i + 1), count); ++k) {
      extend(&box, ranges + first + k);
    }
    ranges[first + count + i] = box;
  }
}

/// Writes the child over the leaves [begin, end): its box is the union of the ranges, on each level
/// at both ends, that no range of the next level covers entirely. `inner` is its index unless it is
/// a leaf.
static inline void put_child(__global Box* child, __global const Box* ranges, uint n, uint begin,
                             uint end, uint inner) {
  const uint number = end - begin == 1 ? begin | LEAF : inner;
  const uint last = end - 1;
  Box box = ranges[begin];
  for (uint count = n; begin < end;) {
    while (begin < end && begin % ARITY != 0) extend(&box, ranges + begin++);
    while (begin < end && end % ARITY != 0) extend(&box, ranges + --end);
    ranges += count;
    count = (count + ARITY - 1) / ARITY;
    begin /= ARITY;
    end /= ARITY;
  }
  box.low.w = as_float(number);
  box.high.w = as_float(last);
  *child = box;
}

/// Finds the children of each inner node (Karras 2012).
__kernel void build(__global const uint* keys, __global const Box* ranges, const uint leaf_count,
                    __global Node* nodes) {
  const int n = (int)leaf_count;
  FOR_EACH_BODY(node, leaf_count - 1) {
    const int i = (int)node;
    const int direction =
        common_bits(keys, n, i, i + 1) > common_bits(keys, n, i, i - 1) ? 1 : -1;
    const int outside = common_bits(keys, n, i, i - direction);
    int reach = 2;
    while (common_bits(keys, n, i, i + reach * direction) > outside) reach *= 2;
    int length = 0;
    for (int step = reach / 2; step > 0; step /= 2) {
      if (common_bits(keys, n, i, i + (length + step) * direction) > outside) length += step;
    }
    const int other_end = i + length * direction;
    const int common = common_bits(keys, n, i, other_end);
    int split = 0;
    for (int step = (length + 1) / 2;; step = (step + 1) / 2) {
      if (common_bits(keys, n, i, i + (split + step) * direction) > common) split += step;
      if (step <= 1) break;
    }
    const uint middle = (uint)(i + split * direction + min(direction, 0));
    const uint first = (uint)min(i, other_end);
    const uint last = (uint)max(i, other_end);
    put_child(&nodes[i].child[0], ranges, leaf_count, first, middle + 1, middle);
    put_child(&nodes[i].child[1], ranges, leaf_count, middle + 1, last + 1, middle + 1);
  }
}

/// The tree of n < 2^31 leaves has a depth of at most 30 + 31: the bits of a key with its index.
#define MAX_DEPTH 64

__kernel void search(__global const Box* leaves, __global const Node* nodes,
                     __global const uint* bodies, const uint n, __global uint2* pairs,
                     volatile __global uint* count, const uint capacity) {
  MAKE_SINK(sink)
  FOR_EACH_BODY(i, n) {
    const float4 low = leaves[i].low;
    const float4 high = leaves[i].high;
    uint stack[MAX_DEPTH];
    int depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
      __global const Node* node = nodes + stack[--depth];
      for (uint side = 0; side < 2; ++side) {
        const Box child = node->child[side];
        // Each pair is found by the earlier of its leaves.
        if (as_uint(child.high.w) <= i || !overlap(low, high, child.low, child.high)) continue;
        const uint number = as_uint(child.low.w);
        if ((number & LEAF) != 0) {
          report(&sink, bodies[i], bodies[number & ~LEAF]);
        } else {
          stack[depth++] = number;
        }
      }
    }
  }
  flush(&sink);
}
