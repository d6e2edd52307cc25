// A conservative proximity test: a coarse grid that marks the cells touched by a set of boxes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "broadmark/aabb.h"

namespace broadmark {

/// 64³ cells over a world, one bit each; the outermost cells extend to infinity. A box that
/// overlaps a marked box always touches a marked cell, since cellOf() is monotone.
class OccupancyBitmap {
 public:
  explicit OccupancyBitmap(const Aabb& world) {
    for (int axis = 0; axis < 3; ++axis) {
      low_[axis] = world.min[axis];
      const float extent = world.max[axis] - world.min[axis];
      cells_per_unit_[axis] = extent > 0 ? kCells / extent : 0;
    }
  }

  void clear() { rows_.assign(kCells * kCells, 0); }

  void mark(const Aabb& box) {
    const std::uint64_t cells = cellsInRow(box);
    forEachRow(box, [&](std::uint64_t& row) {
      row |= cells;
      return false;
    });
  }

  /// Whether the box touches a marked cell.
  [[nodiscard]] bool isNear(const Aabb& box) {
    const std::uint64_t cells = cellsInRow(box);
    return forEachRow(box, [&](const std::uint64_t& row) { return (row & cells) != 0; });
  }

 private:
  static constexpr std::size_t kCells = 64;  ///< per axis: a row is one 64-bit word

  /// Also defined for infinity and NaN.
  [[nodiscard]] std::size_t cellOf(float position, int axis) const {
    const float cell = (position - low_[axis]) * cells_per_unit_[axis];
    if (!(cell > 0)) return 0;
    return cell < kCells ? static_cast<std::size_t>(cell) : kCells - 1;
  }

  [[nodiscard]] std::uint64_t cellsInRow(const Aabb& box) const {
    const std::size_t first = cellOf(box.min[0], 0);
    const std::size_t last = cellOf(box.max[0], 0);
    return ~std::uint64_t{0} >> (kCells - 1 - last) & ~std::uint64_t{0} << first;
  }

  /// Calls visit(row) for the touched rows until a call returns true; returns whether one did.
  template <class Visit>
  bool forEachRow(const Aabb& box, Visit visit) {
    const std::size_t last_y = cellOf(box.max[1], 1);
    const std::size_t first_z = cellOf(box.min[2], 2);
    const std::size_t last_z = cellOf(box.max[2], 2);
    for (std::size_t y = cellOf(box.min[1], 1); y <= last_y; ++y) {
      for (std::size_t z = first_z; z <= last_z; ++z) {
        if (visit(rows_[kCells * y + z])) return true;
      }
    }
    return false;
  }

  std::array<float, 3> low_{};
  std::array<float, 3> cells_per_unit_{};
  std::vector<std::uint64_t> rows_ = std::vector<std::uint64_t>(kCells * kCells, 0);
};

}  // namespace broadmark
