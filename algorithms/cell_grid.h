// A uniform grid of cells over boxes: its cells, the cells that a box touches, and the home cell of
// a pair with several shared cells.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "broadmark/aabb.h"
#include "cell_body.h"
#include "corner.h"

namespace broadmark {

/// A cell by its index on each axis. (The fourth component is padding, 0.)
using CellPosition = std::array<std::int32_t, 4>;

/// The cells that a box touches: first to last on each axis, both inclusive.
struct CellRange {
  alignas(16) CellPosition first{};
  alignas(16) CellPosition last{};

  /// Exact; at most the grid's number of cells.
  [[nodiscard]] std::size_t count() const {
    std::size_t cells = 1;
    for (int axis = 0; axis < 3; ++axis) {
      cells *= static_cast<std::size_t>(last[axis] - first[axis] + 1);
    }
    return cells;
  }
  [[nodiscard]] bool contains(const CellPosition& cell) const {
    return isEveryAxis((cornerOf(first) <= cornerOf(cell)) & (cornerOf(cell) <= cornerOf(last)));
  }
  friend bool operator==(const CellRange&, const CellRange&) = default;
};

/// Cells of equal size, aligned to the axes. The outermost ones extend to infinity, so every box
/// touches at least one cell. A higher coordinate never maps to a lower cell. Correctness rests on
/// that alone: boxes that overlap share a cell.
class CellGrid {
 public:
  /// One cell.
  CellGrid() = default;
  /// Divides a world into `cells_per_axis` cells on each axis.
  CellGrid(const Aabb& world, std::int32_t cells_per_axis);

  /// Fits about `cells` cells (at least one; at most two and a half times as many, by rounding) to
  /// the trimmed range of `boxes`; outliers do not stretch the grid. `columns`: the cells are not
  /// cut on the y axis. Cells are at least about twice as long as the mean box on each axis, so
  /// that boxes of similar size touch few of them.
  void fit(std::span<const Aabb> boxes, std::size_t cells, bool columns);

  [[nodiscard]] std::size_t size() const {
    return static_cast<std::size_t>(counts_[0]) * static_cast<std::size_t>(counts_[1]) *
           static_cast<std::size_t>(counts_[2]);
  }
  [[nodiscard]] const CellPosition& counts() const { return counts_; }
  [[nodiscard]] std::size_t indexOf(std::int32_t x, std::int32_t y, std::int32_t z) const {
    return static_cast<std::size_t>(x) +
           static_cast<std::size_t>(counts_[0]) *
               (static_cast<std::size_t>(y) +
                static_cast<std::size_t>(counts_[1]) * static_cast<std::size_t>(z));
  }

  [[nodiscard]] CellPosition position(std::size_t index) const {
    CellPosition cell{};
    for (int axis = 0; axis < 3; ++axis) {
      const auto count = static_cast<std::size_t>(counts_[axis]);
      cell[axis] = static_cast<std::int32_t>(index % count);
      index /= count;
    }
    return cell;
  }

  [[nodiscard]] CellRange touched(const Aabb& box) const {
    return {cellsOf(box.min), cellsOf(box.max)};
  }

  /// Calls visit(index, phantom bits) for each cell in `range`: see CellBody.
  template <class Visit>
  void forEachCell(const CellRange& range, Visit visit) const {
    if (range.first == range.last) {  // most boxes, and faster than three loops
      visit(indexOf(range.first[0], range.first[1], range.first[2]), CellBody{0});
      return;
    }
    for (std::int32_t z = range.first[2]; z <= range.last[2]; ++z) {
      for (std::int32_t y = range.first[1]; y <= range.last[1]; ++y) {
        for (std::int32_t x = range.first[0]; x <= range.last[0]; ++x) {
          visit(indexOf(x, y, z),
                phantomBits(x != range.first[0], y != range.first[1], z != range.first[2]));
        }
      }
    }
  }

  /// The cell at an index, with its outer sides clipped to `bounds`: for drawing.
  [[nodiscard]] Aabb cell(std::size_t index, const Aabb& bounds) const;

 private:
  void cut(int axis, double low, double extent, double count);
  /// The cells of a box's corner. All axes at once: called twice a frame for each box.
  [[nodiscard]] CellPosition cellsOf(const std::array<float, 4>& corner) const {
    const Corner cell = (cornerOf(corner) - cornerOf(low_)) * cornerOf(scale_);
    // Overflow is clamped to the outermost cells, and NaN (infinity · 0), the first operand, to 0.
    return std::bit_cast<CellPosition>(truncated(smaller(larger(cell, Corner{}), cornerOf(last_))));
  }

  alignas(16) std::array<float, 4> low_{};
  alignas(16) std::array<float, 4> scale_{};  ///< cells per unit of length; 0 for a single cell
  alignas(16) std::array<float, 4> last_{};   ///< counts_ - 1
  CellPosition counts_ = {1, 1, 1, 1};
};

}  // namespace broadmark
