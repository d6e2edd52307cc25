// Overlap tests of boxes against ranges and windows of boxes, one table per instruction set.
#pragma once

#include <cstddef>
#include <cstdint>

#include "broadmark/box_arrays.h"
#include "broadmark/execution.h"
#include "broadmark/pair.h"
#include "broadmark/range.h"
#include "cell_body.h"

namespace broadmark {

struct OverlapKernels {
  std::size_t lanes;  ///< boxes in a vector

  /// Adds every overlapping pair (i, j) with i in `rows`, j in `columns` and i < j.
  void (*test_tile)(const BoxArrays& boxes, Range rows, Range columns, PairBuffer& pairs);

  /// Sweep and prune within a cell: for every i in `rows` and j in its window (i, ends[i]), adds
  /// the pair of bodies[i] and bodies[j] if their boxes overlap and this is their home cell.
  /// Requires ends[i] > i.
  void (*sweep_cells)(const BoxArrays& boxes, const std::uint32_t* ends, const CellBody* bodies,
                      Range rows, PairBuffer& pairs);
};

/// The kernels for an instruction set, which this processor must support.
const OverlapKernels& overlapKernels(Isa isa);

}  // namespace broadmark
