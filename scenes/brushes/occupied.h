// The boxes that are already placed, to find room for more.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "broadmark/aabb.h"

namespace broadmark::scenes {

/// A hash grid of boxes whose longest edge is between half of `reach` and `reach`, by the cell of
/// their lower corner. Cells share as many buckets as there are boxes.
class BoxGrid {
 public:
  explicit BoxGrid(double reach) : reach_(reach), edge_(2 * reach) {}

  void add(const Aabb& box);
  [[nodiscard]] bool overlaps(const Aabb& box) const;

 private:
  using Cell = std::array<std::int64_t, 3>;
  struct Entry {
    Aabb box;
    std::uint32_t next;  ///< box in the same bucket
  };
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;

  [[nodiscard]] std::int64_t indexOf(double coordinate) const;
  [[nodiscard]] std::size_t bucketOf(const Cell& cell) const;
  [[nodiscard]] bool overlapsInBucket(std::size_t bucket, const Aabb& box) const;
  void chain(std::uint32_t index);
  void growTable();

  double reach_;
  double edge_;
  std::vector<Entry> boxes_;
  std::vector<std::uint32_t> first_;  ///< first box by bucket; their number is a power of two
};

/// Boxes, and whether any of them overlaps another box. O(1) per box unless their sizes differ by
/// orders of magnitude, and never more than a comparison with every box.
class Occupied {
 public:
  void add(const Aabb& box);
  [[nodiscard]] bool overlaps(const Aabb& box) const;

 private:
  /// By the exponent of the least power of two above all edges.
  std::map<int, BoxGrid> grids_;
};

}  // namespace broadmark::scenes
