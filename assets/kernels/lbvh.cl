// Linear bounding volume hierarchy: bodies in the order of their centres along a Morton curve; a
// binary radix tree over that order, all nodes at once; boxes from the leaves up; one traversal per
// body.
//
// Inner node k has its two children's boxes side by side, in one cache line. In a child's box,
// low.w is its number (leaves have the highest bit set) and high.w the last leaf below it.

#define LEAF 0x80000000u

typedef struct {
  Box child[2];
} Node;

/// Spreads ten bits out to every third place.
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

/// Length of what two leaves' keys have in common from the left; equal keys go on with their
/// positions. -1 for no such leaf.
static inline int common_bits(__global const uint* keys, int n, int i, int j) {
  if (j < 0 || j >= n) return -1;
  const uint difference = keys[i] ^ keys[j];
  return difference != 0 ? (int)clz(difference) : 32 + (int)clz((uint)(i ^ j));
}

/// Finds the children of inner node i (Karras 2012), and notes the parent of each:
/// 2 * node + which child. Inner nodes' parents stand before those of the leaves.
static inline void link_node(__global const uint* keys, int n, int i, __global Node* nodes,
                             __global uint* parents) {
  const int direction =
      common_bits(keys, n, i, i + 1) > common_bits(keys, n, i, i - 1) ? 1 : -1;
  const int least = common_bits(keys, n, i, i - direction);
  int reach = 2;
  while (common_bits(keys, n, i, i + reach * direction) > least) reach *= 2;
  int length = 0;
  for (int step = reach / 2; step > 0; step /= 2) {
    if (common_bits(keys, n, i, i + (length + step) * direction) > least) length += step;
  }
  const int other_end = i + length * direction;
  const int common = common_bits(keys, n, i, other_end);
  int split = 0;
  for (int step = (length + 1) / 2;; step = (step + 1) / 2) {
    if (common_bits(keys, n, i, i + (split + step) * direction) > common) split += step;
    if (step <= 1) break;
  }
  const int middle = i + split * direction + min(direction, 0);
  const int first = min(i, other_end);
  const int last = max(i, other_end);
  const uint left = first == middle ? (uint)middle | LEAF : (uint)middle;
  const uint right = last == middle + 1 ? (uint)(middle + 1) | LEAF : (uint)(middle + 1);
  nodes[i].child[0].low.w = as_float(left);
  nodes[i].child[0].high.w = as_float((uint)middle);
  nodes[i].child[1].low.w = as_float(right);
  nodes[i].child[1].high.w = as_float((uint)last);
  parents[(left & LEAF) != 0 ? (uint)(n - 1 + middle) : left] = 2 * (uint)i;
  parents[(right & LEAF) != 0 ? (uint)(n + middle) : right] = 2 * (uint)i + 1;
}

/// Also puts the boxes into the leaves' order, and takes the nodes' visits back to 0.
__kernel void build(__global const Box* boxes, __global const uint* keys,
                    __global const uint* bodies, const uint n, __global Box* leaves,
                    __global Node* nodes, __global uint* parents, __global uint* visits) {
  FOR_EACH_BODY(i, n) {
    PREFETCH(boxes + bodies[min(i + PREFETCHED, n - 1)]);
    leaves[i] = boxes[bodies[i]];
    if (i + 1 == n) continue;
    visits[i] = 0;
    link_node(keys, (int)n, (int)i, nodes, parents);
  }
}

/// Sets a box but not its fourth components.
static inline void set_box(volatile __global float* to, float4 low, float4 high) {
  to[0] = low.x;
  to[1] = low.y;
  to[2] = low.z;
  to[4] = high.x;
  to[5] = high.y;
  to[6] = high.z;
}

/// Carries boxes up from leaf to root. Of a node's two children the first to arrive stops there;
/// the second finds both boxes written: the fence puts its own before the count, and the count
/// orders the other's.
__kernel void refit(__global const Box* leaves, const uint n, volatile __global float* node_floats,
                    __global const uint* parents, volatile __global uint* visits) {
  FOR_EACH_BODY(i, n) {
    float4 low = leaves[i].low;
    float4 high = leaves[i].high;
    uint parent = parents[n - 1 + i];
    for (;;) {
      const uint node = parent / 2;
      const uint side = parent & 1;
      set_box(node_floats + 16 * node + 8 * side, low, high);
      mem_fence(CLK_GLOBAL_MEM_FENCE);
      if (atomic_inc(&visits[node]) == 0) break;
      mem_fence(CLK_GLOBAL_MEM_FENCE);
      volatile __global const float* other = node_floats + 16 * node + 8 * (1 - side);
      low = fmin(low, (float4)(other[0], other[1], other[2], 0));    // race: ordered by visits
      high = fmax(high, (float4)(other[4], other[5], other[6], 0));  // race: ordered by visits
      if (node == 0) break;
      parent = parents[node];
    }
  }
}

/// The tree of n < 2^31 leaves is at most 30 + 31 deep: so many bits has a key with its position.
#define DEEPEST 64

__kernel void search(__global const Box* leaves, __global const Node* nodes,
                     __global const uint* bodies, const uint n, __global uint2* pairs,
                     volatile __global uint* count, const uint capacity) {
  MAKE_SINK(sink)
  FOR_EACH_BODY(i, n) {
    const float4 low = leaves[i].low;
    const float4 high = leaves[i].high;
    uint stack[DEEPEST];
    int depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
      __global const Node* node = nodes + stack[--depth];
      for (uint side = 0; side < 2; ++side) {
        const Box child = node->child[side];
        // Each pair is found by the earlier of its leaves.
        if (as_uint(child.high.w) <= i || !meet(low, high, child.low, child.high)) continue;
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
