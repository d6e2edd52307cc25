// Sweep and prune: bodies sorted by the lower bound on one axis; each is tested on the other two
// against those that begin before it ends, sixteen at a time.

/// Padding behind the last body: the sweep loads whole vectors.
#define PADDING 16u

/// Makes a float sort as an unsigned integer; -0 with +0.
static inline uint sort_key(float value) {
  const uint bits = as_uint(value + 0.0f);
  return (bits & 0x80000000u) != 0 ? ~bits : bits | 0x80000000u;
}

static inline float along(float4 corner, uint axis) {
  return axis == 0 ? corner.x : axis == 1 ? corner.y : corner.z;
}

__kernel void make_keys(__global const Box* boxes, const uint n, const uint axis,
                        __global uint* keys, __global uint* bodies) {
  FOR_EACH_BODY(i, n) {
    keys[i] = sort_key(along(boxes[i].low, axis));
    bodies[i] = i;
  }
}

/// The sorted boxes as six arrays of `stride` floats, sort axis first: its lower and upper bounds,
/// then those of the two other axes.
__kernel void gather(__global const Box* boxes, __global const uint* bodies, const uint n,
                     const uint axis, const uint stride, __global float* sorted) {
  FOR_EACH_BODY(i, n + PADDING) {
    for (uint k = 0; k < 3; ++k) {
      const uint from = (axis + k) % 3;
      // Padding meets nothing.
      sorted[2 * k * stride + i] = i < n ? along(boxes[bodies[i]].low, from) : INFINITY;
      sorted[(2 * k + 1) * stride + i] = i < n ? along(boxes[bodies[i]].high, from) : -INFINITY;
    }
  }
}

/// The first position behind i whose lower bound is above `limit`: by doubling, then halving steps.
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
  __global const float* low1 = sorted + 2 * stride;
  __global const float* high1 = sorted + 3 * stride;
  __global const float* low2 = sorted + 4 * stride;
  __global const float* high2 = sorted + 5 * stride;
  MAKE_SINK(sink)
  FOR_EACH_BODY(i, n) {
    const uint end = window_end(sorted, i, n, sorted[stride + i]);
    const float16 own_low1 = (float16)(low1[i]);
    const float16 own_high1 = (float16)(high1[i]);
    const float16 own_low2 = (float16)(low2[i]);
    const float16 own_high2 = (float16)(high2[i]);
    for (uint j = i + 1; j < end; j += 16) {
      const int16 hits = (own_low1 <= vload16(0, high1 + j)) & (vload16(0, low1 + j) <= own_high1) &
                         (own_low2 <= vload16(0, high2 + j)) & (vload16(0, low2 + j) <= own_high2);
      if (!any(hits)) continue;
      int lanes[16];
      vstore16(hits, 0, lanes);
      for (uint k = 0; k < 16 && j + k < end; ++k) {
        if (lanes[k] != 0) report(&sink, bodies[i], bodies[j + k]);
      }
    }
  }
  flush(&sink);
}
