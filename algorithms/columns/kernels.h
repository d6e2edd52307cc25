// The inner loops, one table of them per instruction set.
#pragma once

#include <cstddef>
#include <cstdint>

#include "broadmark/aabb.h"
#include "broadmark/execution.h"
#include "broadmark/pair.h"
#include "broadmark/range.h"
#include "cell_body.h"
#include "columns/cell_entries.h"
#include "columns/layout.h"

namespace broadmark::columns {

/// A block of quantised boxes, as a structure of arrays. A box's home column is the first column
/// that it overlaps.
struct alignas(64) BoxBlock {
  static constexpr std::size_t kBoxes = 128;

  std::uint32_t sweep_min[kBoxes];
  std::uint32_t sweep_max[kBoxes];
  /// On the cut axes, across all columns.
  std::uint32_t cut_min[2][kBoxes];
  std::uint32_t cut_max[2][kBoxes];
  /// Home columns, and the entries there.
  std::uint32_t columns[kBoxes];
  std::uint32_t keys[kBoxes];
  CellEntry entries[kBoxes];
  /// Column boundaries crossed, on both axes together.
  std::uint32_t crossings[kBoxes];
  /// Of boxes that cross one boundary: the second column, and the fields of the entry there that
  /// differ.
  std::uint32_t next_columns[kBoxes];
  std::uint32_t next_keys[kBoxes];
  CellBody next_bodies[kBoxes];

  /// A bit per box.
  using Set = std::uint64_t[kBoxes / 64];
  Set cross_one;
  Set cross_several;
};

class HitBuffer;

struct Kernels {
  /// Quantises up to BoxBlock::kBoxes boxes, and computes their home columns and entries.
  void (*quantize_boxes)(const Aabb* boxes, const CellBody* bodies, std::size_t count,
                         const Quantizers& quantizers, BoxBlock& block);

  /// Copies boxes to `target`, which is aligned to 64 bytes, by non-temporal stores if there are
  /// any; streamFence() makes them visible to other threads.
  void (*stream_copy)(const Aabb* boxes, std::size_t count, Aabb* target);

  /// Tests the entries of `rows` against their windows; up to kSweepRows, and the first is a
  /// multiple of kSweepRows.
  void (*sweep)(const std::uint32_t* keys, const std::uint32_t* ends, Range rows, HitBuffer& hits);
  static constexpr std::size_t kSweepRows = 64;

  /// Extracts one candidate pair from each hit (HitBuffer), compacts the hits that have more to the
  /// front, and returns their number. `pairs` and `ambiguous` are the output positions for certain
  /// and for ambiguous pairs. All four arrays need room for kExtractWidth elements beyond `count`.
  std::size_t (*extract_pairs)(std::uint64_t* positions, std::uint64_t* masks, std::size_t count,
                               const CellEntry* entries, Pair*& pairs, Pair*& ambiguous);
  static constexpr std::size_t kExtractWidth = 8;
};

/// The kernels for an instruction set, which this processor must support.
const Kernels& kernels(Isa isa);

}  // namespace broadmark::columns
