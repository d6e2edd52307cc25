// The inner loops, one table of them per instruction set: boxes into steps, the sweep, and what
// becomes of its hits.
#pragma once

#include <cstddef>
#include <cstdint>

#include "broadmark/aabb.h"
#include "broadmark/execution.h"
#include "broadmark/pair.h"
#include "broadmark/range.h"
#include "columns/copies.h"
#include "columns/layout.h"
#include "marked_body.h"

namespace broadmark::columns {

/// A few boxes among the columns, in one array for each number.
struct alignas(64) BoxBlock {
  static constexpr std::size_t kBoxes = 128;

  /// Steps on the sweep axis.
  std::uint32_t first[kBoxes];
  std::uint32_t last[kBoxes];
  /// Steps on the axes that are cut.
  std::uint32_t low[2][kBoxes];
  std::uint32_t high[2][kBoxes];
  /// The first columns that the boxes touch, and their copies there.
  std::uint32_t columns[kBoxes];
  std::uint32_t keys[kBoxes];
  Copy copies[kBoxes];
  /// How many sides between columns they cross, on both axes together.
  std::uint32_t crossed[kBoxes];
  /// The second columns of those that cross one, and what is different in their copies there.
  std::uint32_t next_columns[kBoxes];
  std::uint32_t next_keys[kBoxes];
  MarkedBody next_bodies[kBoxes];

  /// A set of boxes, a bit for each.
  using Set = std::uint64_t[kBoxes / 64];
  Set cross_one;
  Set cross_more;
};

class HitSink;

struct Kernels {
  /// Finds out about `count` boxes, at most BoxBlock::kBoxes, of these bodies.
  void (*find_steps)(const Aabb* boxes, const MarkedBody* bodies, std::size_t count,
                     const StepScales& scales, BoxBlock& block);

  /// Copies boxes to a place that is aligned to 64 bytes, past the caches if there is a way. Other
  /// threads see it after showWritesPastCaches().
  void (*copy_past_caches)(const Aabb* boxes, std::size_t count, Aabb* to);

  /// Tests all copies in `rows`, at most kSweptRows, the first of which is a multiple of that,
  /// against their windows.
  void (*sweep)(const std::uint32_t* keys, const std::uint32_t* ends, Range rows, HitSink& hits);
  static constexpr std::size_t kSweptRows = 64;

  /// Takes one pair out of each of some hits (HitSink), of these copies. Those hits that have more
  /// go to the beginning; returns how many they are. `pairs` and `doubtful` are where the next pair
  /// goes that is sure, and the next of which the boxes have to decide. In all four arrays there
  /// must be room for one of each hit and kTakenTogether more.
  std::size_t (*take_pairs)(std::uint64_t* places, std::uint64_t* bits, std::size_t count,
                            const Copy* copies, Pair*& pairs, Pair*& doubtful);
  static constexpr std::size_t kTakenTogether = 8;
};

/// The kernels for an instruction set, which this processor must support.
const Kernels& kernels(Isa isa);

}  // namespace broadmark::columns
