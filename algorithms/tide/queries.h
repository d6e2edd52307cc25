// The queries of a frame: a MoveQuery per moving body, from which CellQueries are made.
//
// On a level a box usually overlaps at most two cells on each axis, so a cell query covers a block
// of 2 x 2 x 2 cells; the buckets of unused cells are masked out.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>

#include "broadmark/aabb.h"
#include "corner.h"
#include "tide/bucket_table.h"
#include "tide/grid_layout.h"

namespace broadmark::tide {

/// A cache line: the box of a body, and its box before its last move. The fourth components hold
/// the frame of that move and the cells.
struct alignas(64) Body {
  Aabb box;
  Aabb before;

  [[nodiscard]] std::uint32_t frame() const { return std::bit_cast<std::uint32_t>(box.min[3]); }
  /// kInvalidIndex if the body is absent.
  [[nodiscard]] std::uint32_t cell() const { return std::bit_cast<std::uint32_t>(box.max[3]); }
  [[nodiscard]] std::uint32_t cellBefore() const {
    return std::bit_cast<std::uint32_t>(before.max[3]);
  }
  void move(const Aabb& to, std::uint32_t to_cell, std::uint32_t in_frame) {
    before = box;
    box = to;
    box.min[3] = std::bit_cast<float>(in_frame);
    box.max[3] = std::bit_cast<float>(to_cell);
  }
};

using EventMask = std::uint32_t;
inline constexpr EventMask kBeginEvents = 1;
inline constexpr EventMask kEndEvents = 2;

/// Finds the bodies that may begin or cease to overlap a moving body. A body that moved far has two
/// consecutive queries: one around its old box and one around its new box.
struct alignas(64) MoveQuery {
  GridBox region;
  PackedBounds bounds;  ///< of the body, to be stored in its cell
  std::uint32_t body;
  EventMask events;    ///< kBeginEvents, kEndEvents or both
  std::uint32_t cell;  ///< kInvalidIndex if the body is absent
  std::uint32_t cell_before;
};

/// A query of the buckets of up to eight cells, or of their overflow buckets.
struct alignas(64) CellQuery {
  static constexpr std::uint32_t kBuckets = 8;
  /// In a byte per bucket: a bit per slot, and a bit that is set if there is an overflow bucket.
  static constexpr std::uint64_t kSlotBits = 0x1F1F'1F1F'1F1F'1F1F;
  static constexpr std::uint64_t kOverflowBits = 0x8080'8080'8080'8080;
  static constexpr std::uint64_t kBucketBits = (kSlotBits | kOverflowBits) & 0xFF;

  const CellBucket* buckets[kBuckets];
  PackedBounds packed[kBuckets];  ///< the query box, packed relative to each cell
  std::uint64_t active;           ///< a byte per bucket, kBucketBits or 0
  std::uint32_t move;             ///< index of the MoveQuery in the batch
  std::uint32_t root;             ///< index of the query of the cells' own buckets
};

/// A value per bucket.
using BucketVector = std::uint64_t __attribute__((vector_size(64)));

/// A block of 2 x 2 x 2 cells.
struct CellBlock {
  const CellBucket* first;
  GridCoord offset;      ///< from the first to the second bucket on each axis
  GridCoord has_second;  ///< -1 on axes on which the second cell is queried, else 0
  GridBox query;         ///< relative to the first cell
};

/// Sets all but `move` and `root`. Inlined, to be compiled for a kernel's instruction set.
[[gnu::always_inline]] inline void setBuckets(const CellBlock& block, CellQuery& query) {
  constexpr std::uint64_t kAll = ~std::uint64_t{0};
  constexpr BucketVector kSecond[3] = {{0, kAll, 0, kAll, 0, kAll, 0, kAll},
                                       {0, 0, kAll, kAll, 0, 0, kAll, kAll},
                                       {0, 0, 0, 0, kAll, kAll, kAll, kAll}};
  constexpr std::uint64_t kAxisBytes = 0xFF'0000'00FF;
  static constexpr auto kActive = [] {
    std::array<std::uint64_t, 8> active{};
    for (unsigned axes = 0; axes < 8; ++axes) {
      for (unsigned bucket = 0; bucket < CellQuery::kBuckets; ++bucket) {
        if ((bucket & ~axes) == 0) active[axes] |= CellQuery::kBucketBits << 8 * bucket;
      }
    }
    return active;
  }();
  constexpr std::int32_t kCell = 1 << GridLayout::kCellBits;
  const PackedBounds in_first = GridLayout::packQuery(block.query);
  const PackedBounds in_second =
      GridLayout::packQuery({block.query.min - kCell, block.query.max - kCell});
  BucketVector buckets = BucketVector{} + reinterpret_cast<std::uintptr_t>(block.first);
  BucketVector is_second{};
  for (int axis = 0; axis < 3; ++axis) {
    buckets += kSecond[axis] &
               static_cast<std::uint64_t>(block.offset[axis] * std::int64_t{sizeof(CellBucket)});
    is_second |= kSecond[axis] & kAxisBytes << 8 * axis;
  }
  const BucketVector packed = (~is_second & in_first) | (is_second & in_second);
  if constexpr (sizeof(query.buckets) == sizeof(buckets)) {
    std::memcpy(static_cast<void*>(query.buckets), &buckets, sizeof(buckets));
  } else {  // addresses of four bytes
    for (int i = 0; i < 8; ++i) {
      query.buckets[i] =  // NOLINTNEXTLINE(performance-no-int-to-ptr): the vector holds addresses
          reinterpret_cast<const CellBucket*>(static_cast<std::uintptr_t>(buckets[i]));
    }
  }
  std::memcpy(query.packed, &packed, sizeof(packed));
  query.active = kActive[axesWhere(block.has_second)];
}

}  // namespace broadmark::tide
