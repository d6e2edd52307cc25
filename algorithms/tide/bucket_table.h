// The storage of a loose grid: bodies by cell.
//
// A cell visit is bound by memory latency, so a cell is a single cache line: the indices of up to
// five bodies and their packed bounds, which one vector instruction tests together. A crowded cell
// has a linked list of full overflow buckets.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "broadmark/large_array.h"
#include "tide/grid_layout.h"

namespace broadmark::tide {

/// A cache line. Occupied slots come first.
struct alignas(64) CellBucket {
  static constexpr std::uint32_t kSlots = 5;
  PackedBounds bounds[kSlots] = {kEmptySlot, kEmptySlot, kEmptySlot, kEmptySlot, kEmptySlot};
  std::uint32_t bodies[kSlots] = {kInvalidIndex, kInvalidIndex, kInvalidIndex, kInvalidIndex,
                                  kInvalidIndex};
  std::uint32_t next = kInvalidIndex;  ///< overflow bucket

  /// kSlots if the body is not in the bucket. Branchless, since the slot is unpredictable.
  [[nodiscard]] std::uint32_t slotOf(std::uint32_t body) const {
    unsigned found = 1U << kSlots;
    for (std::uint32_t slot = 0; slot < kSlots; ++slot) {
      found |= unsigned{bodies[slot] == body} << slot;
    }
    return static_cast<std::uint32_t>(std::countr_zero(found));
  }
  [[nodiscard]] std::uint32_t count() const { return slotOf(kInvalidIndex); }
};

/// The cells' own buckets, by cell, followed by the overflow buckets.
class BucketTable {
 public:
  /// Leaves `cells` empty cells.
  void reset(std::uint32_t cells);
  /// Stores a body that `is_new` in the cell, or updates its bounds. Branchless, since callers
  /// cannot predict which of the two applies.
  void put(std::uint32_t cell, std::uint32_t body, PackedBounds bounds, bool is_new) {
    SlotRef ref = {&buckets_[cell], buckets_[cell].slotOf(is_new ? kInvalidIndex : body)};
    if (ref.slot == CellBucket::kSlots) [[unlikely]] {
      ref = is_new ? spill(cell) : find(buckets_[cell].next, body);
    }
    ref.bucket->bounds[ref.slot] = bounds;
    ref.bucket->bodies[ref.slot] = body;
  }
  /// The body must be in the cell.
  void remove(std::uint32_t cell, std::uint32_t body);

  /// Keeps pointers to buckets valid while up to `bodies` bodies are stored.
  void reserve(std::size_t bodies);
  [[nodiscard]] const CellBucket& operator[](std::size_t index) const { return buckets_[index]; }
  [[nodiscard]] const CellBucket* data() const { return buckets_.data(); }
  [[nodiscard]] std::uint32_t indexOf(const CellBucket* bucket) const {
    return static_cast<std::uint32_t>(bucket - buckets_.data());
  }

  /// "" or the broken invariant; `bodies` is the expected population.
  [[nodiscard]] std::string validate(std::size_t bodies) const;

 private:
  struct SlotRef {
    CellBucket* bucket;
    std::uint32_t slot;
  };

  SlotRef find(std::uint32_t bucket, std::uint32_t body);
  SlotRef spill(std::uint32_t cell);
  std::uint32_t allocateBucket();

  std::uint32_t cell_count_ = 0;
  LargeArray<CellBucket> buckets_;
  std::vector<std::uint32_t> free_buckets_;
};

}  // namespace broadmark::tide
