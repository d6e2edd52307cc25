// From the sweep's hits to pairs.
#pragma once

#include <cstddef>
#include <cstdint>

#include "broadmark/aabb.h"
#include "broadmark/pair.h"
#include "columns/cell_entries.h"
#include "columns/kernels.h"

namespace broadmark::columns {

/// Buffers hits of the sweep, and adds the pairs among them.
///
/// A hit is a position, row | distance << 32, and a mask of candidate pairs. Each bit of the mask
/// stands for a lane and an offset, as laid out by the kernels: the entries row + lane and row +
/// lane + distance + offset.
class HitBuffer {
 public:
  /// Borrows everything.
  HitBuffer(const Kernels& kernels, const SortedColumn& sorted, const Aabb* boxes,
            PairBuffer& pairs)
      : kernels_(kernels), sorted_(sorted), boxes_(boxes), pairs_(pairs) {}

  static constexpr std::size_t kReserve = 64;
  /// Returns the size; positions() and masks() then have room for kReserve hits more.
  std::size_t reserve() {
    if (size_ + kReserve > kCapacity) extractPairs();
    return size_;
  }
  std::uint64_t* positions() { return positions_; }
  std::uint64_t* masks() { return masks_; }
  void setSize(std::size_t size) { size_ = size; }
  /// Adds the pairs of all hits. Their order depends only on the hits since the previous flush.
  void flush();

  /// The number of exact tests of ambiguous pairs.
  [[nodiscard]] std::uint64_t boxTests() const { return box_tests_; }

 private:
  static constexpr std::size_t kCapacity = 4 * kReserve;
  static constexpr std::size_t kMaxAmbiguous = 2 * kCapacity;

  void extractPairs();
  void resolveAmbiguous();

  const Kernels& kernels_;
  const SortedColumn& sorted_;
  const Aabb* boxes_;
  PairBuffer& pairs_;
  // No std::array: kernels must not instantiate its functions (simd/for_each_isa.inl).
  alignas(64) std::uint64_t positions_[kCapacity + Kernels::kExtractWidth];
  alignas(64) std::uint64_t masks_[kCapacity + Kernels::kExtractWidth];
  std::size_t size_ = 0;
  Pair ambiguous_[kMaxAmbiguous + Kernels::kExtractWidth];
  std::size_t ambiguous_count_ = 0;
  std::uint64_t box_tests_ = 0;
};

}  // namespace broadmark::columns
