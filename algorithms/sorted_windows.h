// Boxes sorted along an axis, with the window of overlapping boxes behind each: the start of a
// sweep.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "broadmark/box_arrays.h"
#include "broadmark/execution.h"
#include "moments.h"
#include "radix_sort.h"

namespace broadmark {

/// Retains its memory.
class SortedWindows {
 public:
  /// Sorts `count` boxes, of which box_of(i) is the i-th, by their lower bound on axes[0]. Every
  /// step is divided among the team.
  template <class BoxOf>
  void build(std::size_t count, BoxOf box_of, const AxisOrder& axes, ThreadTeam& team) {
    sorter_.resize(count, team.size());
    team.run(count, [&](int, Range part) {
      const std::span<SortEntry> entries = sorter_.entries();
      for (std::size_t i = part.begin; i < part.end; ++i) {
        entries[i] = {sortKey(box_of(i).min[axes[0]]), static_cast<std::uint32_t>(i)};
      }
    });
    sorter_.sort(team);
    boxes_.resize(count);
    bodies_.resize(count);
    ends_.resize(count);
    team.run(count, [&](int, Range part) {
      const std::span<const SortEntry> entries = sorter_.entries();
      for (std::size_t i = part.begin; i < part.end; ++i) {
        bodies_[i] = entries[i].body;
        const Aabb& box = box_of(bodies_[i]);
        for (int axis = 0; axis < 3; ++axis) {
          boxes_.min(axis)[i] = box.min[axes[axis]];
          boxes_.max(axis)[i] = box.max[axes[axis]];
        }
      }
    });
    team.run(count, [&](int, Range part) { findEnds(part); });
  }

  /// The sorted boxes, with their axes in the order of `axes`.
  [[nodiscard]] const BoxArrays& boxes() const { return boxes_; }
  /// The original index of each sorted box.
  [[nodiscard]] const std::vector<std::uint32_t>& bodies() const { return bodies_; }
  /// Box i overlaps the boxes in (i, ends[i]) on the first axis, and none behind.
  [[nodiscard]] const std::vector<std::uint32_t>& ends() const { return ends_; }

 private:
  /// Compares floats, not sort keys: -0 and +0 touch.
  void findEnds(Range rows) {
    const float* const min = boxes_.min(0);
    const float* const max = boxes_.max(0);
    std::size_t end = rows.begin;
    for (std::size_t i = rows.begin; i < rows.end; ++i) {
      end = boundaryNear(std::max(end, i + 1), i + 1, ends_.size(),
                         [&](std::size_t j) { return min[j] <= max[i]; });
      ends_[i] = static_cast<std::uint32_t>(end);
    }
  }

  /// The first position in [first, last) at which `inside` is false, else last; `inside` is
  /// monotonic. Searches from `hint` outwards: O(log distance).
  template <class Inside>
  static std::size_t boundaryNear(std::size_t hint, std::size_t first, std::size_t last,
                                  Inside inside) {
    std::size_t step = 1;
    if (hint < last && inside(hint)) {
      first = hint + 1;
      while (last - first > step && inside(first + step)) {
        first += step + 1;
        step *= 2;
      }
      last = std::min(last, first + step);
    } else {
      last = hint;
      while (last - first > step && !inside(last - step)) {
        last -= step;
        step *= 2;
      }
      if (last - first > step) first = last - step + 1;
    }
    // Branchless, since the outcome is unpredictable.
    for (std::size_t count = last - first; count > 0;) {
      const std::size_t half = (count + 1) / 2;
      first += inside(first + half - 1) ? half : 0;
      count -= half;
    }
    return first;
  }

  RadixSorter sorter_;
  BoxArrays boxes_;
  std::vector<std::uint32_t> bodies_;
  std::vector<std::uint32_t> ends_;
};

}  // namespace broadmark
