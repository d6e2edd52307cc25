#include "tide/bucket_table.h"

#include <utility>

namespace broadmark::tide {

void BucketTable::reset(std::uint32_t cells) {
  cell_count_ = cells;
  buckets_.resize(cells);
  std::ranges::fill(buckets_, CellBucket());
  free_buckets_.clear();
}

void BucketTable::reserve(std::size_t bodies) {
  const std::size_t buckets = buckets_.size();
  buckets_.resize(buckets + bodies);  // at most one new bucket per body
  buckets_.resize(buckets);
}

std::uint32_t BucketTable::allocateBucket() {
  if (free_buckets_.empty()) {
    const auto bucket = static_cast<std::uint32_t>(buckets_.size());
    buckets_.resize(buckets_.size() + 1);
    return bucket;
  }
  const std::uint32_t bucket = free_buckets_.back();
  free_buckets_.pop_back();
  return bucket;
}

/// The body must be in this bucket or in one linked from it.
BucketTable::SlotRef BucketTable::find(std::uint32_t bucket, std::uint32_t body) {
  for (;; bucket = buckets_[bucket].next) {
    const std::uint32_t slot = buckets_[bucket].slotOf(body);
    if (slot < CellBucket::kSlots) return {&buckets_[bucket], slot};
  }
}

/// Moves the full bucket of a cell to the overflow list, which keeps insertion O(1): only the
/// cell's own bucket ever has empty slots.
BucketTable::SlotRef BucketTable::spill(std::uint32_t cell) {
  const std::uint32_t overflow = allocateBucket();
  buckets_[overflow] = std::exchange(buckets_[cell], CellBucket());
  buckets_[cell].next = overflow;
  return {&buckets_[cell], 0};
}

void BucketTable::remove(std::uint32_t cell, std::uint32_t body) {
  const SlotRef hole = find(cell, body);
  CellBucket& own = buckets_[cell];
  const std::uint32_t last = own.count() - 1;
  hole.bucket->bodies[hole.slot] = own.bodies[last];
  hole.bucket->bounds[hole.slot] = own.bounds[last];
  own.bounds[last] = kEmptySlot;
  own.bodies[last] = kInvalidIndex;
  if (own.next != kInvalidIndex && last == 0) {
    free_buckets_.push_back(own.next);
    own = buckets_[own.next];
  }
}

std::string BucketTable::validate(std::size_t bodies) const {
  std::size_t stored = 0;
  std::size_t buckets = free_buckets_.size();
  for (std::uint32_t cell = 0; cell < cell_count_; ++cell) {
    if (buckets_[cell].count() == 0 && buckets_[cell].next != kInvalidIndex) {
      return "an empty cell bucket has an overflow bucket";
    }
    for (std::uint32_t bucket = cell; bucket != kInvalidIndex; bucket = buckets_[bucket].next) {
      if (bucket != cell && buckets_[bucket].count() < CellBucket::kSlots) {
        return "an overflow bucket is not full";
      }
      stored += buckets_[bucket].count();
      ++buckets;
    }
  }
  if (stored != bodies) return "the cells hold a wrong number of bodies";
  return buckets == buckets_.size() ? std::string() : "a bucket is unreachable";
}

}  // namespace broadmark::tide
