// The inner loops of Tide, with one table of them for each instruction set.
#pragma once

#include <cstddef>
#include <cstdint>

#include "broadmark/execution.h"
#include "tide/queries.h"

namespace broadmark::tide {

/// Bits of a cell query's buckets.
struct Hit {
  std::uint64_t bits;  ///< a byte per bucket: CellQuery::kSlotBits or kOverflowBits
  std::uint32_t query;
};

struct Kernels {
  /// Moves the bodies to their boxes and writes up to two move queries for each; returns the number
  /// of queries. `boxes` and `states` have an element for every body of the scene.
  std::size_t (*move_bodies)(GridLayout& layout, std::uint32_t frame, const std::uint32_t* bodies,
                             std::size_t count, const Aabb* boxes, Body* states,
                             MoveQuery* queries);

  /// Makes the query of a level, except for its indices. Returns false if the box needs more than
  /// two cells on an axis, or cells outside of the level's dims.
  bool (*make_query)(const GridLayout& layout, const CellBucket* buckets, const GridBox& box,
                     std::uint32_t level, CellQuery& query);

  struct Counts {
    std::size_t hits;
    std::size_t overflows;
  };

  /// Runs the queries, which are numbered from `first`. Lists those that hit any slot and those
  /// with overflow buckets. Both lists need room for `count` elements.
  Counts (*run_queries)(const CellQuery* queries, std::size_t count, std::uint32_t first, Hit* hits,
                        Hit* overflows);
};

/// The kernels for an instruction set, which this processor must support.
const Kernels& kernels(Isa isa);

}  // namespace broadmark::tide
