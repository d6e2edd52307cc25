// Bodies that have never moved and do not meet each other, such as a level's.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "broadmark/box_arrays.h"
#include "broadmark/collision_filter.h"
#include "broadmark/pair.h"
#include "broadmark/range.h"
#include "broadmark/strangers.h"
#include "simd/overlap_kernels.h"

namespace broadmark::kd {

/// Finds those of them that overlap a box. They can only be taken out. O(log n) for either.
class Rest {
 public:
  /// One worker's memory for its searches.
  struct Scratch {
    PairBuffer hits;
    std::vector<std::uint32_t> blocks;
    std::uint64_t boxes_tested = 0;  ///< since somebody set it to 0
  };

  /// Takes those of `bodies` that it can, if that is most of them. `boxes`: one per body, whether
  /// it is there or not. To be called once.
  void build(std::span<const Aabb> boxes, std::span<const std::uint32_t> bodies,
             const CollisionFilter& filter, int workers);

  [[nodiscard]] std::size_t size() const { return bodies_.size() - removed_; }
  [[nodiscard]] bool holds(std::uint32_t body) const {
    return !places_.empty() && places_[body] != kNowhere;
  }
  /// Whether the body may be wanted as a pair with any that was taken.
  [[nodiscard]] bool meets(std::uint32_t body) const { return strangers_.meet(body); }
  /// Takes a body out. Workers may do that at the same time, and then say so to removed().
  void remove(std::uint32_t body);
  void removed(std::size_t bodies) { removed_ += bodies; }

  /// Adds the pair of `body` and every one that overlaps `box`, if it is wanted.
  void search(std::uint32_t body, const Aabb& box, int worker, const OverlapKernels& kernels,
              Scratch& scratch, PairBuffer& pairs);

  [[nodiscard]] std::string validate(std::span<const Aabb> boxes) const;

 private:
  static constexpr std::size_t kBlock = 16;  ///< lanes of the widest vector
  static constexpr std::uint32_t kNowhere = std::numeric_limits<std::uint32_t>::max();

  void addLevel(std::span<const Aabb> boxes);
  [[nodiscard]] std::vector<Aabb> blockBoxes(const BoxArrays& level) const;
  [[nodiscard]] Range blockAt(const BoxArrays& level, std::size_t block) const;

  CollisionFilter filter_;
  Strangers strangers_;
  std::vector<std::uint32_t> bodies_;  ///< that were taken, neighbours side by side
  std::vector<std::uint32_t> places_;  ///< by body: where in bodies_, or kNowhere
  std::size_t removed_ = 0;
  /// The bodies' boxes, then of each level's blocks of kBlock boxes the boxes around them, until
  /// there is one block. Before each level there is room for the box that a worker searches for.
  std::vector<BoxArrays> levels_;
  std::size_t first_ = 0;  ///< where a level's boxes begin
};

}  // namespace broadmark::kd
