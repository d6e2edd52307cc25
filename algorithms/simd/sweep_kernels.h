// Sweep and prune on vectors, one table per instruction set. Apart from OverlapKernels, as the
// library in broadphase/ does without.
#pragma once

#include <cstddef>
#include <cstdint>

#include "broadmark/box_arrays.h"
#include "broadmark/execution.h"
#include "broadmark/pair.h"
#include "broadmark/range.h"
#include "cell_body.h"

namespace broadmark {

struct SweepKernels {
  /// For every i in `rows` and j in its window (i, ends[i]), adds the pair of
  /// bodies[i] and bodies[j] if their boxes overlap on axes 1 and 2; on axis 0, the sort axis, all
  /// in the window do. Requires ends[i] > i.
  void (*sweep)(const BoxArrays& boxes, const std::uint32_t* ends, const std::uint32_t* bodies,
                Range rows, PairBuffer& pairs);

  /// For every j > row in `columns`, adds the pair of `body`, at `row`, and bodies[j] if their
  /// boxes overlap and this is their home cell.
  void (*test_row)(const BoxArrays& boxes, std::size_t row, CellBody body, Range columns,
                   const CellBody* bodies, PairBuffer& pairs);
};

/// The kernels for an instruction set, which this processor must support.
const SweepKernels& sweepKernels(Isa isa);

}  // namespace broadmark
