// Stable radix sort of 32-bit keys with 32-bit values, least significant digit first. A pass is
// three kernels: count the digits of each block, compute prefix sums, scatter. Two variants:
//
// serial_*  a work item processes a whole block sequentially: for a CPU
// group_*   a work group processes a block of GROUP_BLOCK elements: for a GPU
//
// Counts are ordered by digit, then by block.

/// Maximum number of digits in a pass.
#define SERIAL_DIGITS 2048u

__kernel void serial_count(__global const uint* keys, const uint n, const uint shift,
                           const uint digits, const uint block_size, __global uint* counts) {
  const uint block = get_global_id(0);
  const uint blocks = get_global_size(0);
  uint own[SERIAL_DIGITS];
  for (uint d = 0; d < digits; ++d) own[d] = 0;
  const uint end = min((block + 1) * block_size, n);
  for (uint i = block * block_size; i < end; ++i) ++own[keys[i] >> shift & (digits - 1)];
  for (uint d = 0; d < digits; ++d) counts[d * blocks + block] = own[d];
}

/// Exclusive prefix sums of the counts. One work item.
__kernel void serial_places(__global uint* counts, const uint size) {
  uint sum = 0;
  for (uint i = 0; i < size; ++i) {
    const uint count = counts[i];
    counts[i] = sum;
    sum += count;
  }
}

__kernel void serial_scatter(__global const uint* keys, __global const uint* values, const uint n,
                             const uint shift, const uint digits, const uint block_size,
                             __global const uint* places, __global uint* to_keys,
                             __global uint* to_values) {
  const uint block = get_global_id(0);
  const uint blocks = get_global_size(0);
  uint own[SERIAL_DIGITS];
  for (uint d = 0; d < digits; ++d) own[d] = places[d * blocks + block];
  const uint end = min((block + 1) * block_size, n);
  for (uint i = block * block_size; i < end; ++i) {
    const uint key = keys[i];
    const uint to = own[key >> shift & (digits - 1)]++;
    to_keys[to] = key;
    to_values[to] = values[i];
  }
}

#define GROUP_DIGITS 16u
#define GROUP_SIZE 128u
#define ITEM_BLOCK 4u
#define GROUP_BLOCK (GROUP_SIZE * ITEM_BLOCK)

__kernel __attribute__((reqd_work_group_size(GROUP_SIZE, 1, 1))) void group_count(
    __global const uint* keys, const uint n, const uint shift, __global uint* counts) {
  __local uint own[GROUP_DIGITS];
  const uint item = get_local_id(0);
  if (item < GROUP_DIGITS) own[item] = 0;
  barrier(CLK_LOCAL_MEM_FENCE);
  for (uint k = 0; k < ITEM_BLOCK; ++k) {
    const uint i = get_group_id(0) * GROUP_BLOCK + k * GROUP_SIZE + item;
    if (i < n) atomic_inc(&own[keys[i] >> shift & (GROUP_DIGITS - 1)]);
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  if (item < GROUP_DIGITS) counts[item * get_num_groups(0) + get_group_id(0)] = own[item];
}

/// The exclusive prefix sum over the group's items; all items of the group must call it.
static inline uint sum_before(uint value, __local uint* scratch) {
  const uint item = get_local_id(0);
  scratch[item] = value;
  barrier(CLK_LOCAL_MEM_FENCE);
  for (uint step = 1; step < GROUP_SIZE; step *= 2) {
    const uint left = item >= step ? scratch[item - step] : 0;
    barrier(CLK_LOCAL_MEM_FENCE);
    scratch[item] += left;
    barrier(CLK_LOCAL_MEM_FENCE);
  }
  const uint sum = scratch[item] - value;
  barrier(CLK_LOCAL_MEM_FENCE);
  return sum;
}

/// As serial_places, by a single work group.
__kernel __attribute__((reqd_work_group_size(GROUP_SIZE, 1, 1))) void group_places(
    __global uint* counts, const uint size) {
  __local uint scratch[GROUP_SIZE];
  const uint item = get_local_id(0);
  const uint share = (size + GROUP_SIZE - 1) / GROUP_SIZE;
  const uint begin = min(item * share, size);
  const uint end = min(begin + share, size);
  uint own = 0;
  for (uint i = begin; i < end; ++i) own += counts[i];
  uint sum = sum_before(own, scratch);
  for (uint i = begin; i < end; ++i) {
    const uint count = counts[i];
    counts[i] = sum;
    sum += count;
  }
}

__kernel __attribute__((reqd_work_group_size(GROUP_SIZE, 1, 1))) void group_scatter(
    __global const uint* keys, __global const uint* values, const uint n, const uint shift,
    __global const uint* places, __global uint* to_keys, __global uint* to_values) {
  __local uint scratch[GROUP_SIZE];
  // The number of elements of each digit in the items before.
  __local uint before[GROUP_DIGITS * GROUP_SIZE];
  const uint item = get_local_id(0);
  const uint begin = get_group_id(0) * GROUP_BLOCK + item * ITEM_BLOCK;
  for (uint d = 0; d < GROUP_DIGITS; ++d) before[d * GROUP_SIZE + item] = 0;
  for (uint i = begin; i < min(begin + ITEM_BLOCK, n); ++i) {
    ++before[(keys[i] >> shift & (GROUP_DIGITS - 1)) * GROUP_SIZE + item];
  }
  for (uint d = 0; d < GROUP_DIGITS; ++d) {
    const uint own = before[d * GROUP_SIZE + item];
    before[d * GROUP_SIZE + item] = sum_before(own, scratch);
  }
  for (uint i = begin; i < min(begin + ITEM_BLOCK, n); ++i) {
    const uint key = keys[i];
    const uint digit = key >> shift & (GROUP_DIGITS - 1);
    const uint to = places[digit * get_num_groups(0) + get_group_id(0)] +
                    before[digit * GROUP_SIZE + item]++;
    to_keys[to] = key;
    to_values[to] = values[i];
  }
}
