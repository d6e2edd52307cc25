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
class HitSink {
 public:
  /// All are borrowed.
  HitSink(const Kernels& kernels, const Sorted& sorted, const Aabb* boxes, PairBuffer& pairs)
      : kernels_(kernels), sorted_(sorted), boxes_(boxes), pairs_(pairs) {}

  /// Where the next hits go: room for kRoom of them, which count after advance().
  static constexpr std::size_t kRoom = 64;
  Hits* room() {
    if (size_ + kRoom > kSize) takeAll();
    return hits_ + size_;
  }
  void advance(const Hits* end) { size_ = static_cast<std::size_t>(end - hits_); }
  /// Adds the pairs of all hits. The order of the pairs follows from the hits since the flush
  /// before.
  void flush();

  /// Pairs of which the boxes decided.
  [[nodiscard]] std::uint64_t comparedBoxes() const { return compared_boxes_; }

 private:
  static constexpr std::size_t kSize = 4 * kRoom;
  static constexpr std::size_t kMostDoubts = 2 * kSize;

  void takeAll();
  void takeOneEach();
  void decide();

  const Kernels& kernels_;
  const Sorted& sorted_;
  const Aabb* boxes_;
  PairBuffer& pairs_;
  Hits hits_[kSize];  // no std::array: kernels must not instantiate its functions
  std::size_t size_ = 0;
  Pair doubtful_[kMostDoubts + 1];  ///< hits of which some bounds share a step
  std::size_t doubts_ = 0;
  std::uint64_t compared_boxes_ = 0;
};

}  // namespace broadmark::columns
