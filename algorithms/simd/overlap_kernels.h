// The inner loops of brute force and sweep and prune, one table of them per instruction set.
#pragma once

#include <cstddef>
#include <cstdint>

#include "broadmark/box_arrays.h"
#include "broadmark/execution.h"
#include "broadmark/pair.h"
#include "broadmark/range.h"
#include "marked_body.h"

namespace broadmark {

struct OverlapKernels {
  std::size_t lanes;  ///< boxes in a vector

  /// Adds every overlapping pair (i, j) with i in `rows`, j in `columns` and i < j.
  void (*test_tile)(const BoxArrays& boxes, Range rows, Range columns, PairBuffer& pairs);

  /// Adds the pair of bodies[i] and bodies[j] for every i in `rows` and j in (i, ends[i]) whose
  /// boxes overlap on axes 1 and 2; ends[i] > i for all rows. (Axis 0 is the sort axis: all j in
  /// the window overlap i there.)
  void (*sweep)(const BoxArrays& boxes, const std::uint32_t* ends, const std::uint32_t* bodies,
                Range rows, PairBuffer& pairs);

  /// Adds the pair of bodies[i] and bodies[j] for every i in `rows` and j in (i, ends[i]) whose
  /// boxes overlap and that are to be reported where they are; ends[i] > i for all rows.
  void (*sweep_cells)(const BoxArrays& boxes, const std::uint32_t* ends, const MarkedBody* bodies,
                      Range rows, PairBuffer& pairs);

  /// Adds the pair of `body`, whose box is at `row`, and bodies[j] for every j > row in `columns`
  /// whose boxes overlap and that are to be reported where they are.
  void (*test_row)(const BoxArrays& boxes, std::size_t row, MarkedBody body, Range columns,
                   const MarkedBody* bodies, PairBuffer& pairs);
};

/// The kernels for an instruction set, which this processor must support.
const OverlapKernels& overlapKernels(Isa isa);

}  // namespace broadmark
