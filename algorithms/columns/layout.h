// Where the columns lie: which axes are cut, how often, and where a box lies among them, in small
// integers.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "broadmark/aabb.h"

namespace broadmark::columns {

/// How the coordinates on an axis become steps: (coordinate - low) * factor, from 0 to `last`. What
/// overflows gets an outermost step, and NaN (infinity · 0) gets 0.
struct StepScale {
  int axis = 0;
  float low = 0;
  float factor = 0;
  float last = 0;
};
struct StepScales {
  std::array<StepScale, 2> of;  ///< the axes that are cut
  StepScale sweep;
  std::uint32_t columns_in_row = 1;  ///< on the first of these
};

/// Columns over two axes; along the third, the sweep axis, they are not cut. Coordinates are turned
/// into steps, whole numbers: on the two axes 256 of them across each column, on the sweep axis as
/// many as floats can tell apart.
///
/// A higher coordinate never gets a lower step: what lies outside gets the first or the last one.
/// Correctness rests on that alone: boxes that overlap do so in steps, too, and boxes that overlap
/// in steps without touching do overlap.
class Layout {
 public:
  static constexpr int kStepBits = 8;
  static constexpr std::uint32_t kLastStep = (1 << kStepBits) - 1;
  static constexpr int kSweepBits = 31;
  static constexpr std::size_t kMostColumns = std::size_t{1} << 12;

  /// One column.
  Layout() = default;
  /// The columns that are expected to cost least for `count` boxes of which `sample` are some,
  /// chosen evenly. To copy a box into a column, and to put it in order there, costs as much as
  /// `copy_cost` tests of a pair. A sample that misleads costs time, nothing else.
  Layout(std::span<const Aabb> sample, std::size_t count, double copy_cost);

  /// Half as many columns on each axis that is cut.
  void widen();

  [[nodiscard]] std::size_t size() const {
    return static_cast<std::size_t>(counts_[0]) * static_cast<std::size_t>(counts_[1]);
  }
  /// What finding the pairs of a box is expected to cost, copying included.
  [[nodiscard]] double costPerBox() const { return cost_; }

  /// What part of the copies in a column a box meets on the sweep axis, behind its lower bound.
  [[nodiscard]] double metPart() const { return met_; }

  /// The column at a place on the first axis that is cut, and one on the second.
  [[nodiscard]] std::size_t indexOf(std::uint32_t first, std::uint32_t second) const {
    return std::size_t{second} * scales_.columns_in_row + first;
  }

  [[nodiscard]] const StepScales& scales() const { return scales_; }

  /// The column at an index, within `bounds`: for drawing.
  [[nodiscard]] Aabb column(std::size_t index, const Aabb& bounds) const;

 private:
  StepScales scales_;
  std::array<std::int32_t, 2> counts_ = {1, 1};  ///< on the first axis that is cut, and the second
  double cost_ = 0;
  double met_ = 0;
};

}  // namespace broadmark::columns
