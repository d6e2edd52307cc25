// Counts the tests of each body, for drawing: recomputed from the tested ranges.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "broadmark/debug_draw.h"
#include "broadmark/range.h"

namespace broadmark {

/// Tests between the rows of an ordered array of boxes. A row against any range of rows is counted
/// in O(1).
class TestCounts {
 public:
  explicit TestCounts(std::size_t rows) : own_(rows), changes_(rows + 1) {}

  /// A row was tested against each of these.
  void add(std::size_t row, Range others) {
    own_[row] += static_cast<std::uint32_t>(others.size());
    ++changes_[others.begin];
    --changes_[others.end];
  }
  /// Each row i against those in (i, ends[i]).
  void addWindows(std::span<const std::uint32_t> ends) {
    for (std::size_t row = 0; row < ends.size(); ++row) add(row, {row + 1, ends[row]});
  }

  /// Reports the counts for bodyOf(row).
  template <class BodyOf>
  void report(DebugDraw& draw, BodyOf bodyOf) const {
    std::uint32_t by_others = 0;
    for (std::size_t row = 0; row < own_.size(); ++row) {
      by_others += changes_[row];
      draw.tests(bodyOf(row), own_[row] + by_others);
    }
  }

 private:
  std::vector<std::uint32_t> own_;
  /// Difference array of the number of rows tested against each row.
  std::vector<std::uint32_t> changes_;
};

}  // namespace broadmark
