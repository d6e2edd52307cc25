// The sweep of columns in which many copies overlap.
#pragma once

#include <cstdint>

#include "broadmark/aabb.h"
#include "broadmark/box_arrays.h"
#include "broadmark/large_array.h"
#include "broadmark/pair.h"
#include "broadmark/range.h"
#include "columns/copies.h"
#include "marked_body.h"
#include "simd/overlap_kernels.h"

namespace broadmark::columns {

/// Tests the boxes themselves, so that a hit is a pair at once: a hit costs less than in the sweep
/// of keys, a miss more. It keeps its memory.
class DenseSweep {
 public:
  /// Whether this is the faster sweep for a column, by a sample of its tests: that follows from the
  /// column alone.
  [[nodiscard]] static bool pays(const Sorted& column);

  /// Takes a column, which is borrowed. `boxes` are by body.
  void begin(const Sorted& column, const Aabb* boxes);
  /// Adds the pairs of some rows of that column.
  void sweep(const OverlapKernels& kernels, Range rows, PairBuffer& pairs) const;

 private:
  const std::uint32_t* ends_ = nullptr;
  BoxArrays arrays_;  ///< of the copies
  LargeArray<MarkedBody> bodies_;
};

}  // namespace broadmark::columns
