// Sweep and prune: bodies sorted by the lower bound on one axis; each is tested on the other two
// axes against the bodies that begin before it ends.

/// Maps a float to an unsigned integer of the same order; -0 equals +0.
static inline uint sort_key(float value) {
  const uint bits = as_uint(value + 0.0f);
  return (bits & 0x80000000u) != 0 ? ~bits : bits | 0x80000000u;
}

/// The components in the order of the sweep's axes: the sort axis first.
static inline float4 from_axis(float4 corner, uint axis) {
  return axis == 0 ? corner : axis == 1 ? corner.yzxw : corner.zxyw;
}

__kernel void make_keys(__global const Box* boxes, const uint n, const uint axis,
                        __global uint* keys, __global uint* bodies) {
  FOR_EACH_BODY(i, n) {
    keys[i] = sort_key(from_axis(boxes[i].low, axis).x);
    bodies[i] = i;
  }
}

/// Puts the boxes into the sort order.
__kernel void gather(__global const Box* boxes, __global const uint* bodies, const uint n,
                     const uint axis, const uint stride, __global float* sorted) {
  FOR_EACH_BODY(i, n + PADDING) {
    PREFETCH(boxes + bodies[min(i + PREFETCHED, n - 1)]);
    const float4 low = i < n ? boxes[bodies[i]].low : (float4)(INFINITY);
    const float4 high = i < n ? boxes[bodies[i]].high : (float4)(-INFINITY);
    put_sorted(sorted, stride, i, from_axis(low, axis), from_axis(high, axis));
  }
}

/// The first index behind i with a lower bound above `limit`: exponential, then binary search.
static inline uint window_end(__global const float* lows, uint i, uint n, float limit) {
  uint step = 1;
  uint inside = i;
  while (inside + step < n && lows[inside + step] <= limit) {
    inside += step;
    step *= 2;
  }
  for (; step > 0; step /= 2) {
    if (inside + step < n && lows[inside + step] <= limit) inside += step;
  }
  return inside + 1;
}

__kernel void search(__global const float* sorted, __global const uint* bodies, const uint n,
                     const uint stride, __global uint2* pairs, volatile __global uint* count,
                     const uint capacity) {
  __global const float* second = sorted + 2 * stride;
  __global const float* third = sorted + 4 * stride;
  MAKE_SINK(sink)
  FOR_EACH_BODY(i, n) {
    const uint end = window_end(sorted, i, n, sorted[stride + i]);
    const float low2 = second[i];
    const float high2 = second[stride + i];
    const float low3 = third[i];
    const float high3 = third[stride + i];
    for (uint block = i + 1; block < end; block += LANES) {
      const uint hits = bits_of(reach(second + block, stride, low2, high2) &
                                reach(third + block, stride, low3, high3));
      FOR_EACH_HIT(j, hits, block, end) report(&sink, bodies[i], bodies[j]);
    }
  }
  flush(&sink);
}
