// Common code of all kernels. Written for OpenCL C 1.2.
//
// BODIES_PER_ITEM  bodies that a work item processes sequentially: hundreds on a CPU, where work
//                  items are cheap only in groups; 1 on a GPU
// PAIRS_HELD       pairs that a work item buffers before it reserves space for all of them with one
//                  atomic operation
// LANES            sorted bodies that are tested at once: 16 on a CPU, with vectors per work item;
//                  1 on a GPU, with work items as lanes

// Multiplications and additions must round equally in every kernel: cells depend on it.
#pragma OPENCL FP_CONTRACT OFF

#define ALWAYS_INLINE static inline __attribute__((always_inline))

/// On a CPU, prefetches a box that will be read PREFETCHED bodies later, at an unpredictable
/// address. PoCL's prefetch() does nothing; its compiler has a builtin that works.
#define PREFETCHED 24u
#if LANES == 1
#define PREFETCH(box)
#elif defined(POCL_DEVICE_ADDRESS_BITS)
#define PREFETCH(box) __builtin_prefetch(box)
#else
#define PREFETCH(box) prefetch((__global const float*)(box), 8)
#endif

/// The bodies i of [0, n) of this work item.
#define FOR_EACH_BODY(i, n)                                                  \
  for (uint i = get_global_id(0) * BODIES_PER_ITEM,                          \
            end_ = min(i + (uint)BODIES_PER_ITEM, (uint)(n));                \
       i < end_; ++i)

/// A box: its lower and its upper corner; the fourth components are available for other data.
typedef struct {
  float4 low;
  float4 high;
} Box;

/// Padding after the last sorted body: a vector of bodies that overlap nothing.
#define PADDING 16u

/// Sorted boxes are six arrays of `stride` floats: lower and upper bounds on the first axis, on the
/// second, on the third.
static inline void put_sorted(__global float* sorted, uint stride, uint i, float4 low,
                              float4 high) {
  sorted[i] = low.x;
  sorted[stride + i] = high.x;
  sorted[2 * stride + i] = low.y;
  sorted[3 * stride + i] = high.y;
  sorted[4 * stride + i] = low.z;
  sorted[5 * stride + i] = high.z;
}

#if LANES == 16
typedef int16 Lanes;
#define LOAD_LANES(from) vload16(0, from)

/// The lanes or'ed together. Compilers recognise this form as a reduction, but not any().
static inline uint folded(int16 lanes) {
  const int8 eight = lanes.lo | lanes.hi;
  const int4 four = eight.lo | eight.hi;
  const int2 two = four.lo | four.hi;
  return (uint)(two.x | two.y);
}

/// A bit for each lane that is true.
static inline uint bits_of(int16 lanes) {
  if (folded(lanes) == 0) return 0;
  return folded(lanes & (int16)(0x1, 0x2, 0x4, 0x8, 0x10, 0x20, 0x40, 0x80, 0x100, 0x200, 0x400,
                                0x800, 0x1000, 0x2000, 0x4000, 0x8000));
}
#else
typedef int Lanes;
#define LOAD_LANES(from) (*(from))
static inline uint bits_of(int lane) { return lane != 0; }
#endif

/// The lanes of LANES sorted bodies that overlap [low, high] on one axis: `lows` points to the
/// first body's lower bound.
static inline Lanes reach(__global const float* lows, uint stride, float low, float high) {
  return (LOAD_LANES(lows) <= high) & (low <= LOAD_LANES(lows + stride));
}

/// Iterates over bodies `block` ... before `end`, as j; bit k of `hits` stands for the k-th.
#define FOR_EACH_HIT(j, hits, block, end)                                             \
  for (uint left_ = (end) - (block) < LANES ? (hits) & ((1u << ((end) - (block))) - 1) : (hits), \
            j = (block) + 31 - clz(left_);                                            \
       left_ != 0; left_ ^= 1u << (j - (block)), j = (block) + 31 - clz(left_))

/// Closed intersection: touching counts.
static inline int overlap(float4 a_low, float4 a_high, float4 b_low, float4 b_high) {
  return (a_low.x <= b_high.x) & (b_low.x <= a_high.x) & (a_low.y <= b_high.y) &
         (b_low.y <= a_high.y) & (a_low.z <= b_high.z) & (b_low.z <= a_high.z);
}

/// Counting stops about here: 32 bits must not wrap around.
#define MAX_PAIRS 0x80000000u

/// The output of a work item. Pairs beyond the capacity are only counted.
typedef struct {
  __global uint2* pairs;
  volatile __global uint* count;
  uint capacity;
  uint held;
  uint2 buffer[PAIRS_HELD];
} Sink;

static inline void flush(Sink* sink) {
  if (sink->held == 0 || *sink->count > MAX_PAIRS) return;  // race: an old count is right, too
  const uint at = atomic_add(sink->count, sink->held);
  for (uint k = 0; k < sink->held && at + k < sink->capacity; ++k) {
    sink->pairs[at + k] = sink->buffer[k];
  }
  sink->held = 0;
}

static inline void report(Sink* sink, uint a, uint b) {
  if (sink->held == PAIRS_HELD) flush(sink);
  if (sink->held < PAIRS_HELD) sink->buffer[sink->held++] = (uint2)(min(a, b), max(a, b));
}

/// For search kernels: a sink of the arguments `pairs`, `count` and `capacity`.
#define MAKE_SINK(name) \
  Sink name;            \
  name.pairs = pairs;   \
  name.count = count;   \
  name.capacity = capacity; \
  name.held = 0;

/// Over the strips [s * strip, (s + 1) * strip) of the boxes, for work item s: the bounds of all
/// corners, the sums of the longest edges, and of the centres and their squares relative to the
/// first box's centre. Five float4 each.
__kernel void summarise(__global const Box* boxes, const uint n, const uint strip,
                        __global float4* summaries) {
  const uint s = get_global_id(0);
  const uint begin = min(s * strip, n);
  const uint end = min(begin + strip, n);
  float4 low = (float4)(FLT_MAX);
  float4 high = (float4)(-FLT_MAX);
  float4 edges = (float4)(0);
  float4 sum = (float4)(0);
  float4 squares = (float4)(0);
  const float4 origin = n > 0 ? 0.5f * boxes[0].low + 0.5f * boxes[0].high : (float4)(0);
  for (uint i = begin; i < end; ++i) {
    const Box box = boxes[i];
    low = fmin(low, box.low);
    high = fmax(high, box.high);
    const float4 size = box.high - box.low;
    edges.x += fmin(fmax(size.x, fmax(size.y, size.z)), 1e30f);
    const float4 centre = (0.5f * box.low + 0.5f * box.high) - origin;
    sum += centre;
    squares += centre * centre;
  }
  summaries[5 * s] = low;
  summaries[5 * s + 1] = high;
  summaries[5 * s + 2] = edges;
  summaries[5 * s + 3] = sum;
  summaries[5 * s + 4] = squares;
}
