// A conservative proximity test: a coarse grid that marks the cells touched by a set of boxes.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "broadmark/aabb.h"

namespace broadmark {

/// Cells over a world, one bit each: 64 along x, and along y and z as many as pay for the number of
/// bodies, up to 64. The outermost cells extend to infinity. A box that overlaps a marked box
/// always touches a marked cell, since cellOf() is monotone.
class OccupancyBitmap {
 public:
  OccupancyBitmap(const Aabb& world, std::size_t bodies) {
    // Of more rows, a box touches several, and all of them are cleared in every frame.
    const auto edge = static_cast<std::size_t>(std::cbrt(static_cast<double>(bodies)));
    const std::size_t rows = std::clamp<std::size_t>(std::bit_ceil(2 * edge), 4, kMaxCells);
    cells_ = {kMaxCells, rows, rows};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low_[axis] = world.min[axis];
      const float extent = world.max[axis] - world.min[axis];
      cells_per_unit_[axis] = extent > 0 ? static_cast<float>(cells_[axis]) / extent : 0;
    }
    clear();
  }

  void clear() { rows_.assign(cells_[1] * cells_[2], 0); }

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
  static constexpr std::size_t kMaxCells = 64;  ///< per axis: a row is one 64-bit word

  /// Also defined for infinity and NaN.
  [[nodiscard]] std::size_t cellOf(float position, std::size_t axis) const {
    const float cell = (position - low_[axis]) * cells_per_unit_[axis];
    if (!(cell > 0)) return 0;
    return cell < static_cast<float>(cells_[axis]) ? static_cast<std::size_t>(cell)
                                                   : cells_[axis] - 1;
  }

  [[nodiscard]] std::uint64_t cellsInRow(const Aabb& box) const {
    const std::size_t first = cellOf(box.min[0], 0);
    const std::size_t last = cellOf(box.max[0], 0);
    return ~std::uint64_t{0} >> (kMaxCells - 1 - last) & ~std::uint64_t{0} << first;
  }

  /// Calls visit(row) for the touched rows until a call returns true; returns whether one did.
  template <class Visit>
  bool forEachRow(const Aabb& box, Visit visit) {
    const std::size_t last_y = cellOf(box.max[1], 1);
    const std::size_t first_z = cellOf(box.min[2], 2);
    const std::size_t last_z = cellOf(box.max[2], 2);
    for (std::size_t y = cellOf(box.min[1], 1); y <= last_y; ++y) {
      for (std::size_t z = first_z; z <= last_z; ++z) {
        if (visit(rows_[cells_[2] * y + z])) return true;
      }
    }
    return false;
  }

  std::array<std::size_t, 3> cells_{};  ///< by axis
  std::array<float, 3> low_{};
  std::array<float, 3> cells_per_unit_{};
  std::vector<std::uint64_t> rows_;
};

}  // namespace broadmark
