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

  /// Sweep and prune: for every i in `rows` and j in its window (i, ends[i]), adds the pair of
  /// bodies[i] and bodies[j] if their boxes overlap on axes 1 and 2; on axis 0, the sort axis, all
  /// in the window do. Requires ends[i] > i.
  void (*sweep)(const BoxArrays& boxes, const std::uint32_t* ends, const std::uint32_t* bodies,
                Range rows, PairBuffer& pairs);

  /// The same within a cell, on all axes, and only for pairs with this home cell.
  void (*sweep_cells)(const BoxArrays& boxes, const std::uint32_t* ends, const CellBody* bodies,
                      Range rows, PairBuffer& pairs);

  /// For every j > row in `columns`, adds the pair of `body`, at `row`, and bodies[j] if their
  /// boxes overlap and this is their home cell.
  void (*test_row)(const BoxArrays& boxes, std::size_t row, CellBody body, Range columns,
                   const CellBody* bodies, PairBuffer& pairs);
};

/// The kernels for an instruction set, which this processor must support.
const OverlapKernels& overlapKernels(Isa isa);

}  // namespace broadmark
