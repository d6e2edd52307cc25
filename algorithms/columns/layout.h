// The layout of the columns: which axes are cut, how often, and how coordinates are quantised.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "broadmark/aabb.h"

namespace broadmark::columns {

/// Quantises the coordinates of an axis: (coordinate - origin) * scale, clamped to [0, max] and
/// truncated. Overflow is clamped too, and NaN (infinity * 0) becomes 0.
struct Quantizer {
  int axis = 0;
  float origin = 0;
  float scale = 0;
  float max = 0;
};
struct Quantizers {
  std::array<Quantizer, 2> cut;
  Quantizer sweep;
  std::uint32_t columns_per_row = 1;  ///< a row lies along the first cut axis
};

/// Columns over two cut axes, along the third, the sweep axis. Coordinates are quantised: on a cut
/// axis to 256 values across each column, on the sweep axis to 31 bits.
///
/// Quantisation is monotonic, and coordinates outside the layout are clamped. Correctness rests on
/// that alone: quantised boxes overlap wherever boxes do, and quantised boxes that overlap without
/// equal bounds belong to boxes that do.
class Layout {
 public:
  static constexpr int kCoordBits = 8;
  static constexpr std::uint32_t kMaxCoord = (1 << kCoordBits) - 1;
  static constexpr int kSweepBits = 31;
  static constexpr std::size_t kMaxColumns = std::size_t{1} << 12;

  /// One column.
  Layout() = default;
  /// The layout of minimal expected cost for `count` boxes, from an even sample of them. Binning
  /// and sorting an entry costs `copy_cost` pair tests. A misleading sample costs time, not
  /// correctness.
  Layout(std::span<const Aabb> sample, std::size_t count, double copy_cost);

  /// Halves the number of columns on each cut axis.
  void coarsen();

  [[nodiscard]] std::size_t size() const {
    return static_cast<std::size_t>(counts_[0]) * static_cast<std::size_t>(counts_[1]);
  }
  /// Expected cost of a box, binning included, in pair tests.
  [[nodiscard]] double costPerBox() const { return cost_; }

  /// Expected fraction of a column's entries in the window of an entry.
  [[nodiscard]] double overlapFraction() const { return overlap_fraction_; }

  /// The index of the column at positions a and b on the cut axes.
  [[nodiscard]] std::size_t indexOf(std::uint32_t a, std::uint32_t b) const {
    return std::size_t{b} * quantizers_.columns_per_row + a;
  }

  [[nodiscard]] const Quantizers& quantizers() const { return quantizers_; }

  /// The box of a column within `bounds`, for drawing.
  [[nodiscard]] Aabb columnBox(std::size_t index, const Aabb& bounds) const;

 private:
  Quantizers quantizers_;
  std::array<std::int32_t, 2> counts_ = {1, 1};  ///< columns on each cut axis
  double cost_ = 0;
  double overlap_fraction_ = 0;
};

}  // namespace broadmark::columns
