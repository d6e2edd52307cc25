// The inner loops, one table of them per instruction set: boxes into steps, and the sweep.
#pragma once

#include <cstddef>
#include <cstdint>

#include "broadmark/aabb.h"
#include "broadmark/execution.h"
#include "broadmark/range.h"
#include "columns/copies.h"
#include "columns/layout.h"

namespace broadmark::columns {

/// Which columns a box touches beside its first one.
enum Crossing : std::uint32_t {
  kNone,
  kFirstAxis,   ///< the next one on the first axis that is cut
  kSecondAxis,  ///< the next one on the second
  kOtherwise,
  kCrossings
};

/// A few boxes among the columns, in one array for each number.
struct BoxBlock {
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
  std::uint32_t crossing[kBoxes];  ///< Crossing of each
};

/// Pairs of copies whose keys overlap: which ones follows from the bits, see Kernels.
struct Hits {
  std::uint32_t row;
  std::uint32_t column;
  std::uint64_t bits;
};

class HitSink;

struct Kernels {
  /// Bit k of hits is of the copies row + row_of[k] and column + lane_of[k].
  std::uint8_t row_of[64];
  std::uint8_t lane_of[64];

  /// Finds out about `count` boxes, at most BoxBlock::kBoxes, of these bodies.
  void (*find_steps)(const Aabb* boxes, const MarkedBody* bodies, std::size_t count,
                     const StepScales& scales, BoxBlock& block);

  /// Tests all copies in `rows`, at most kSweptRows, the first of which is a multiple of that,
  /// against their windows.
  void (*sweep)(const std::uint32_t* keys, const std::uint32_t* ends, Range rows, HitSink& hits);
  static constexpr std::size_t kSweptRows = 64;
};

/// The kernels for an instruction set, which this processor must support.
const Kernels& kernels(Isa isa);

}  // namespace broadmark::columns
