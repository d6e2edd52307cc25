// From hits of the sweep to pairs.
#pragma once

#include <cstddef>
#include <cstdint>

#include "broadmark/aabb.h"
#include "broadmark/pair.h"
#include "columns/copies.h"
#include "columns/kernels.h"

namespace broadmark::columns {

/// Takes hits and adds the pairs among them.
///
/// A hit has a place, row | distance << 32, and bits. Each bit is of a pair of copies: of a lane
/// and a step, as kernels lay them out, it is row + lane and the one distance + step behind it.
class HitSink {
 public:
  /// All are borrowed.
  HitSink(const Kernels& kernels, const Sorted& sorted, const Aabb* boxes, PairBuffer& pairs)
      : kernels_(kernels), sorted_(sorted), boxes_(boxes), pairs_(pairs) {}

  /// Where the next hits go in places() and bits(): room for kRoom of them, which count after
  /// advance().
  static constexpr std::size_t kRoom = 64;
  std::size_t room() {
    if (size_ + kRoom > kSize) takeAll();
    return size_;
  }
  std::uint64_t* places() { return places_; }
  std::uint64_t* bits() { return bits_; }
  void advance(std::size_t end) { size_ = end; }
  /// Adds the pairs of all hits. The order of the pairs follows from the hits since the flush
  /// before.
  void flush();

  /// Pairs of which the boxes decided.
  [[nodiscard]] std::uint64_t comparedBoxes() const { return compared_boxes_; }

 private:
  static constexpr std::size_t kSize = 4 * kRoom;
  static constexpr std::size_t kMostDoubts = 2 * kSize;

  void takeAll();
  void decide();

  const Kernels& kernels_;
  const Sorted& sorted_;
  const Aabb* boxes_;
  PairBuffer& pairs_;
  // No std::array: kernels must not instantiate its functions.
  alignas(64) std::uint64_t places_[kSize + Kernels::kTakenTogether];
  alignas(64) std::uint64_t bits_[kSize + Kernels::kTakenTogether];
  std::size_t size_ = 0;
  /// Hits of which some bounds share a step.
  Pair doubtful_[kMostDoubts + Kernels::kTakenTogether];
  std::size_t doubts_ = 0;
  std::uint64_t compared_boxes_ = 0;
};

}  // namespace broadmark::columns
