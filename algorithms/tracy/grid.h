// Which cells of a uniform grid a box touches.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "broadmark/aabb.h"

namespace broadmark::tracy {

/// A cell by its number on each axis.
using CellPosition = std::array<std::uint16_t, 3>;

/// Where a body pokes out of a cell that it touches: bit `axis` if it begins in a lower cell on
/// that axis, bit `axis` + 3 if it ends in a higher one.
using Crossing = std::uint8_t;
constexpr Crossing crossesBelow(int axis) { return static_cast<Crossing>(1 << axis); }
constexpr Crossing crossesAbove(int axis) { return static_cast<Crossing>(8 << axis); }
constexpr Crossing kCrossesBelow = crossesBelow(0) | crossesBelow(1) | crossesBelow(2);

/// A block of cells, both corners included; none at all if low is above high.
struct CellRange {
  CellPosition low{};
  CellPosition high{};

  [[nodiscard]] bool contains(const CellPosition& cell) const {
    bool inside = true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      inside = inside && low[axis] <= cell[axis] && cell[axis] <= high[axis];
    }
    return inside;
  }
  [[nodiscard]] std::uint64_t size() const {
    if (low[0] > high[0]) return 0;
    std::uint64_t cells = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      cells *= static_cast<std::uint64_t>(high[axis] - low[axis]) + 1;
    }
    return cells;
  }
  [[nodiscard]] Crossing crossing(const CellPosition& cell) const {
    unsigned bits = 0;
    for (int axis = 0; axis < 3; ++axis) {
      if (low[axis] < cell[axis]) bits |= crossesBelow(axis);
      if (cell[axis] < high[axis]) bits |= crossesAbove(axis);
    }
    return static_cast<Crossing>(bits);
  }

  friend bool operator==(const CellRange&, const CellRange&) = default;
};

/// Equal cells over a world. The outermost go on without end: no box is outside of the grid.
class Grid {
 public:
  static constexpr std::uint32_t kMostCellsPerAxis = 1024;

  Grid() = default;
  Grid(const Aabb& world, std::uint32_t cells_per_axis) : cells_per_axis_(cells_per_axis) {
    for (int axis = 0; axis < 3; ++axis) {
      origin_[axis] = world.min[axis];
      extent_[axis] = static_cast<double>(world.max[axis]) - origin_[axis];
      const bool flat = !(extent_[axis] > 0);
      per_unit_[axis] = flat ? 0 : cells_per_axis_ / extent_[axis];
    }
  }

  [[nodiscard]] std::uint32_t cellsPerAxis() const { return cells_per_axis_; }
  [[nodiscard]] std::size_t cellCount() const {
    return std::size_t{cells_per_axis_} * cells_per_axis_ * cells_per_axis_;
  }

  [[nodiscard]] CellRange range(const Aabb& box) const {
    if (isEmpty(box)) return {.low = {1, 1, 1}, .high = {0, 0, 0}};
    CellRange cells;
    for (int axis = 0; axis < 3; ++axis) {
      cells.low[axis] = cellOf(box.min[axis], axis);
      cells.high[axis] = cellOf(box.max[axis], axis);
    }
    return cells;
  }

  [[nodiscard]] std::size_t index(const CellPosition& cell) const {
    return (std::size_t{cell[2]} * cells_per_axis_ + cell[1]) * cells_per_axis_ + cell[0];
  }
  [[nodiscard]] CellPosition position(std::size_t index) const {
    const auto along = [&](std::size_t i) {
      return static_cast<std::uint16_t>(i % cells_per_axis_);
    };
    return {along(index), along(index / cells_per_axis_),
            along(index / cells_per_axis_ / cells_per_axis_)};
  }

  /// A cell as it is within the world.
  [[nodiscard]] Aabb bounds(const CellPosition& cell) const {
    const auto border = [&](int axis, int number) {
      return static_cast<float>(origin_[axis] + extent_[axis] * number / cells_per_axis_);
    };
    Aabb box;
    for (int axis = 0; axis < 3; ++axis) {
      box.min[axis] = border(axis, cell[axis]);
      box.max[axis] = border(axis, cell[axis] + 1);
    }
    return box;
  }

  /// Calls visit(position, index) for each cell of a block.
  template <class Visit>
  void forEachCell(const CellRange& cells, Visit visit) const {
    for (std::uint16_t z = cells.low[2]; z <= cells.high[2]; ++z) {
      for (std::uint16_t y = cells.low[1]; y <= cells.high[1]; ++y) {
        for (std::uint16_t x = cells.low[0]; x <= cells.high[0]; ++x) {
          const CellPosition cell = {x, y, z};
          visit(cell, index(cell));
        }
      }
    }
  }

 private:
  /// Never falls as the coordinate rises: all that is said of cells rests on that.
  [[nodiscard]] std::uint16_t cellOf(float coordinate, int axis) const {
    const double cell = (coordinate - origin_[axis]) * per_unit_[axis];
    return static_cast<std::uint16_t>(
        std::clamp(cell, 0.0, static_cast<double>(cells_per_axis_ - 1)));
  }

  std::uint32_t cells_per_axis_ = 1;
  std::array<double, 3> origin_{};
  std::array<double, 3> extent_{};
  std::array<double, 3> per_unit_{};
};

}  // namespace broadmark::tracy
