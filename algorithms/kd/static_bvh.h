// A flat bounding volume hierarchy over static bodies that do not collide with each other.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "broadmark/box_arrays.h"
#include "broadmark/collision_filter.h"
#include "broadmark/non_colliding_layers.h"
#include "broadmark/pair.h"
#include "broadmark/range.h"
#include "simd/overlap_kernels.h"

namespace broadmark::kd {

/// Sixteen children to a node. Bodies can be removed, but not inserted. O(log n) for a query.
class StaticBvh {
 public:
  /// The memory of one worker's queries.
  struct Scratch {
    PairBuffer hits;
    std::vector<std::uint32_t> nodes;
    std::uint64_t boxes_tested = 0;
  };

  /// Takes the bodies of non-colliding layers, if they are most of `bodies`. `boxes` has one for
  /// every body of the scene. To be called once.
  void build(std::span<const Aabb> boxes, std::span<const std::uint32_t> bodies,
             const CollisionFilter& filter, int workers);

  [[nodiscard]] std::size_t size() const { return bodies_.size() - removed_; }
  [[nodiscard]] bool contains(std::uint32_t body) const {
    return !index_of_.empty() && index_of_[body] != kInvalidIndex;
  }
  [[nodiscard]] bool collidesWith(std::uint32_t body) const {
    return layers_.collideWith(filter_.layerOf(body));
  }
  /// Thread-safe. The caller then passes the number of removed bodies to countRemoved().
  void remove(std::uint32_t body);
  void countRemoved(std::size_t bodies) { removed_ += bodies; }

  /// Adds the wanted pairs of `body` with the static bodies that overlap `box`.
  void query(std::uint32_t body, const Aabb& box, int worker, const OverlapKernels& kernels,
             Scratch& scratch, PairBuffer& pairs);

  [[nodiscard]] std::string validate(std::span<const Aabb> boxes) const;

 private:
  static constexpr std::size_t kNodeWidth = 16;  ///< lanes of the widest vector
  static constexpr std::uint32_t kInvalidIndex = std::numeric_limits<std::uint32_t>::max();

  void addLevel(std::span<const Aabb> boxes);
  [[nodiscard]] std::vector<Aabb> parentBoxes(const BoxArrays& level) const;
  [[nodiscard]] Range childrenOf(const BoxArrays& level, std::size_t node) const;

  CollisionFilter filter_;
  NonCollidingLayers layers_;
  std::vector<std::uint32_t> bodies_;    ///< in the order of the leaves
  std::vector<std::uint32_t> index_of_;  ///< by body: index into bodies_ or kInvalidIndex
  std::size_t removed_ = 0;
  /// Bottom-up: the boxes of the bodies, then those of each level of nodes, up to a level that fits
  /// in one node. Each level begins with a row per worker, for the box of its query.
  std::vector<BoxArrays> levels_;
  std::size_t query_rows_ = 0;
};

}  // namespace broadmark::kd
