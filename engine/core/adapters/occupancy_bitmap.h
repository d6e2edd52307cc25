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
    row_length_ = rows;
    constexpr auto kCells = static_cast<float>(kMaxCells);
    const auto others = static_cast<float>(rows);
    const Floats cells = {kCells, others, others, 1};
    for (int axis = 0; axis < 3; ++axis) {
      const auto index = static_cast<std::size_t>(axis);
      const float extent = world.max[index] - world.min[index];
      low_[axis] = world.min[index];
      cells_per_unit_[axis] = extent > 0 ? cells[axis] / extent : 0;
      last_cell_[axis] = cells[axis] - 1;
    }
    clear();
  }

  void clear() { rows_.assign(row_length_ * row_length_, 0); }

  void mark(const Aabb& box) {
    forEachRow(box, [](std::uint64_t& row, std::uint64_t cells) {
      row |= cells;
      return false;
    });
  }

  /// Whether the box touches a marked cell.
  [[nodiscard]] bool isNear(const Aabb& box) {
    return forEachRow(
        box, [](const std::uint64_t& row, std::uint64_t cells) { return (row & cells) != 0; });
  }

 private:
  static constexpr std::size_t kMaxCells = 64;  ///< per axis: a row is one 64-bit word

  // All axes at once, by the vector extensions of GCC and clang.
  using Floats [[gnu::vector_size(16)]] = float;
  using Integers [[gnu::vector_size(16)]] = std::int32_t;

  /// Also defined for infinity and NaN.
  [[nodiscard]] Integers cellsOf(const std::array<float, 4>& position) const {
    const Floats zero = {};
    Floats cell = (std::bit_cast<Floats>(position) - low_) * cells_per_unit_;
    cell = cell > zero ? cell : zero;
    cell = cell < last_cell_ ? cell : last_cell_;
    return __builtin_convertvector(cell, Integers);
  }

  /// Calls visit(row, its touched cells) for the touched rows until a call returns true; returns
  /// whether one did.
  template <class Visit>
  bool forEachRow(const Aabb& box, Visit visit) {
    const Integers first = cellsOf(box.min);
    const Integers last = cellsOf(box.max);
    const std::uint64_t cells = ~std::uint64_t{0} >> (static_cast<int>(kMaxCells) - 1 - last[0]) &
                                ~std::uint64_t{0} << first[0];
    for (std::int32_t y = first[1]; y <= last[1]; ++y) {
      for (std::int32_t z = first[2]; z <= last[2]; ++z) {
        if (visit(rows_[row_length_ * static_cast<std::size_t>(y) + static_cast<std::size_t>(z)],
                  cells)) {
          return true;
        }
      }
    }
    return false;
  }

  std::size_t row_length_ = 0;  ///< cells along y and z
  Floats low_{};
  Floats cells_per_unit_{};
  Floats last_cell_{};
  std::vector<std::uint64_t> rows_;
};

}  // namespace broadmark
