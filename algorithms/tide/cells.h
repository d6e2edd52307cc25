// Where boxes lie among the cells of a loose grid.
//
// A box lies in one cell, by its lower corner. Cells have room for the longest edge of their boxes:
// who looks for what overlaps a box looks as far below it as these reach. There are several levels,
// each of cells four times as long as those of the one before; a box lies in the first one whose
// cells are no shorter than it is. So small and large boxes don't get in each other's way.
//
// A level has cells for the bulk of the world only. Beyond, it begins anew from the other side:
// what lies far off shares cells with others, costs tests, and needs no bounds.
//
// Coordinates are turned into whole numbers first, steps, 64 to a cell of level 0. A higher
// coordinate never gets a lower step, whatever is rounded: correctness rests on that alone.
//
// After: T. Ulrich, "Loose Octrees", Game Programming Gems, 2000; C. Ericson, "Real-Time Collision
// Detection", 2005, 7.2.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <span>

#include "broadmark/aabb.h"
#include "corner.h"
#include "sample.h"

namespace broadmark::tide {

inline constexpr std::uint32_t kNowhere = std::numeric_limits<std::uint32_t>::max();

/// Where a coordinate lies, on three axes; the fourth number means nothing.
using Steps = WholeCorner;

inline std::uint32_t sumOfAxes(Steps numbers) {
  return static_cast<std::uint32_t>(numbers[0] + numbers[1] + numbers[2]);
}

/// A box in steps.
struct Extent {
  Steps min;
  Steps max;
  [[nodiscard]] Steps edges() const { return max - min; }
};

/// Of a box in a cell: on each axis a byte for its upper bound, counted down from kLastInCell, and
/// one for its lower bound, counted from the cell's beginning. Of a box that is looked for: what
/// these may be at most for the two to overlap. No byte is above kLastInCell; one that belongs to
/// no axis is 0, but in kNobody.
using Bounds = std::uint64_t;
inline constexpr std::int32_t kLastInCell = 127;       ///< a loose cell is as long as two
inline constexpr Bounds kNobody = Bounds{0x7F} << 24;  ///< within no limits

inline bool areWithin(Bounds bounds, Bounds limits) {
  constexpr Bounds kHighest = 0x8080'8080'8080'8080;
  return (((limits | kHighest) - bounds) & kHighest) == kHighest;
}

/// The cells of all levels, numbered one after the other.
class Cells {
 public:
  static constexpr int kCellBits = 6;   ///< of the steps in a cell of level 0
  static constexpr int kLevelBits = 2;  ///< cells are 2^that times as long from level to level
  static constexpr int kLevels = 13;    ///< the last one takes the longest edges that there are

  struct Level {
    Steps first{};    ///< the cell at which the bulk begins
    Steps counts{};   ///< cells
    Steps reach{};    ///< the longest edges of boxes there were, in steps
    Steps strides{};  ///< from one cell to the next
    std::uint32_t first_cell = 0;
  };

  /// In which cells of a level somebody may overlap an extent, counted from where steps begin.
  struct Range {
    Steps first;
    Steps last;
  };
  /// These cells, each of them once, and the extent there.
  struct Surroundings {
    Steps first;    ///< counted from the level's first cell; beyond the last one they begin anew
    Steps counts;   ///< how many on each axis
    Extent extent;  ///< counted from the beginning of the first one
  };

  /// Chooses them for these boxes. O(n).
  void choose(std::span<const Aabb> boxes);
  [[nodiscard]] std::uint32_t count() const { return count_; }

  [[nodiscard]] Extent extentOf(const Aabb& box) const {
    return {stepsOf(box.min), stepsOf(box.max)};
  }
  static std::uint32_t levelOf(const Extent& extent);
  [[nodiscard]] std::uint32_t cellOf(const Extent& extent, std::uint32_t level) const {
    const Level& at = levels_[level];
    return at.first_cell + sumOfAxes(wrapped(extent.min >> shiftOf(level), at) * at.strides);
  }
  /// kNowhere if the box is empty.
  [[nodiscard]] std::uint32_t cellOf(const Aabb& box) const {
    if (isEmpty(box)) return kNowhere;
    const Extent extent = extentOf(box);
    return cellOf(extent, levelOf(extent));
  }
  /// The bounds of an extent in the cell of a box, which is part of it and of that level.
  [[nodiscard]] Bounds boundsOf(const Extent& extent, const Extent& box, std::uint32_t level) const;
  /// What the bounds of those who overlap an extent may be at most.
  static Bounds limitsOf(const Extent& in_cell) { return bytesOf(in_cell.min, in_cell.max); }

  /// From now on there is such a box.
  void reach(const Extent& extent, std::uint32_t level) {
    used_levels_ |= 1U << level;
    levels_[level].reach = larger(levels_[level].reach, extent.edges());
  }
  /// A bit for each level where there has been a box.
  [[nodiscard]] std::uint32_t usedLevels() const { return used_levels_; }
  [[nodiscard]] const Level& level(std::uint32_t level) const { return levels_[level]; }
  /// Of the length of a cell, in steps, the logarithm.
  static int shiftOf(std::uint32_t level) {
    return kCellBits + kLevelBits * static_cast<int>(level);
  }
  [[nodiscard]] Range rangeAround(const Extent& extent, std::uint32_t level) const {
    const int shift = shiftOf(level);
    return {(extent.min - levels_[level].reach) >> shift, extent.max >> shift};
  }
  /// The extent counted from the beginning of a cell of this level, 64 to a cell.
  static Extent countedFrom(Steps cell, const Extent& extent, std::uint32_t level) {
    const int to_level = shiftOf(level) - kCellBits;
    const Steps begin = cell << kCellBits;
    return {(extent.min >> to_level) - begin, (extent.max >> to_level) - begin};
  }
  [[nodiscard]] Surroundings surroundings(const Extent& extent, std::uint32_t level) const;

  /// The box around a cell, which is counted from where steps begin.
  [[nodiscard]] Aabb boxOf(Steps cell, std::uint32_t level) const;

 private:
  static constexpr float kLastStep = static_cast<float>(1 << 29);

  [[nodiscard]] Steps stepsOf(const std::array<float, 4>& corner) const {
    // The fourth number of a body's box is a whole one. As a float it is below what is normal, with
    // which processors take long to calculate.
    constexpr WholeCorner kAxes = {-1, -1, -1, 0};
    const auto on_axes = std::bit_cast<Corner>(std::bit_cast<WholeCorner>(corner) & kAxes);
    const Corner steps = (on_axes - cornerOf(low_)) * factor_;
    return truncated(smaller(larger(steps, Corner{} - kLastStep), Corner{} + kLastStep));
  }
  /// Counted from the first cell on each axis; those beyond the last ones begin anew.
  static Steps wrapped(Steps cells, const Level& at) {
    const Steps from_first = cells - at.first;
    if (isEveryAxis((from_first >= 0) & (from_first < at.counts))) [[likely]]
      return from_first;
    return wrappedFarOff(from_first, at);
  }
  static Steps wrappedFarOff(Steps from_first, const Level& at);
  static Bounds bytesOf(Steps counted_down, Steps counted);

  void chooseSteps(std::span<const Aabb> boxes, std::span<const Aabb> sample,
                   const std::array<TrimmedRange, 3>& bulk);
  void chooseLevels(std::span<const Aabb> boxes, const std::array<TrimmedRange, 3>& bulk);

  std::array<float, 4> low_{};
  float factor_ = 1;  ///< steps to a unit of length
  std::array<Level, kLevels> levels_;
  std::uint32_t used_levels_ = 0;
  std::uint32_t count_ = 0;
};

inline std::uint32_t Cells::levelOf(const Extent& extent) {
  const Steps edges = extent.edges();
  const std::int32_t longest =
      edges[0] > edges[1] ? std::max(edges[0], edges[2]) : std::max(edges[1], edges[2]);
  std::uint32_t level = 0;
  while (level + 1 < kLevels && longest > 1 << shiftOf(level)) ++level;
  return level;
}

/// The bytes of all axes, of which the former are counted down; what is lower or higher than they
/// can tell counts as their limit.
inline Bounds Cells::bytesOf(Steps counted_down, Steps counted) {
  const Steps from_last = kLastInCell - counted_down;
#if defined(__SSE2__)
  // What lies beyond a narrower number becomes its limit.
  const __m128i words =
      _mm_packs_epi32(std::bit_cast<__m128i>(from_last), std::bit_cast<__m128i>(counted));
  const __m128i bytes =
      _mm_min_epu8(_mm_packus_epi16(words, words), _mm_set1_epi8(static_cast<char>(kLastInCell)));
  return std::bit_cast<std::array<Bounds, 2>>(bytes)[0] & 0x00FF'FFFF'00FF'FFFF;
#else
  Bounds bounds = 0;
  for (int axis = 0; axis < 3; ++axis) {
    bounds |= static_cast<Bounds>(std::clamp(from_last[axis], 0, kLastInCell)) << 8 * axis;
    bounds |= static_cast<Bounds>(std::clamp(counted[axis], 0, kLastInCell)) << 8 * (axis + 4);
  }
  return bounds;
#endif
}

inline Bounds Cells::boundsOf(const Extent& extent, const Extent& box, std::uint32_t level) const {
  const Level& at = levels_[level];
  const Steps cell = box.min >> shiftOf(level);
  // Who looks into a cell takes it for one in the bulk.
  const Steps from_first = cell - at.first;
  const Steps in_bulk =
      (from_first >= 0) & (from_first < at.counts) & (extent.min >> shiftOf(level) == cell);
  const Extent in_cell = countedFrom(cell, extent, level);
  return bytesOf(in_bulk ? in_cell.max : Steps{} + kLastInCell, in_bulk & in_cell.min);
}

}  // namespace broadmark::tide
