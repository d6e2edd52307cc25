// The layout of a hierarchical loose grid: how boxes are quantized, and which cell stores them.
//
// A box is stored in exactly one cell, by its lower corner. Cells are loose: a query expands its
// lower bound by the largest extent stored on the level. Each level has cells four times as long as
// the level below; a box is stored on the first level with cells no shorter than its longest edge,
// so small and large boxes do not slow each other down.
//
// A level has cells for the trimmed range of the scene only. Coordinates outside wrap around, as in
// a hashed grid: outliers share cells with other bodies and cost tests, but need no world bounds.
//
// Coordinates are quantized to integers first, 64 to a cell of level 0. Correctness rests on one
// property: quantization is monotonic, whatever the rounding.
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

inline constexpr std::uint32_t kInvalidIndex = std::numeric_limits<std::uint32_t>::max();

/// Quantized coordinates, or cells, on three axes; the fourth component is unused.
using GridCoord = WholeCorner;

inline std::uint32_t sumOfAxes(GridCoord coord) {
  return static_cast<std::uint32_t>(coord[0] + coord[1] + coord[2]);
}

/// A quantized box.
struct GridBox {
  GridCoord min;
  GridCoord max;
  [[nodiscard]] GridCoord size() const { return max - min; }
};

/// The bounds of a stored box relative to its cell, one byte per axis and side: upper bounds as
/// kMaxCellOffset - max, lower bounds as min. A query is packed as the largest bytes that an
/// overlapping box may have. No byte exceeds kMaxCellOffset; unused bytes are 0, except in
/// kEmptySlot.
using PackedBounds = std::uint64_t;
inline constexpr std::int32_t kMaxCellOffset = 127;  ///< a loose cell is two cells long
inline constexpr PackedBounds kEmptySlot = PackedBounds{0x7F} << 24;  ///< overlaps no query

inline bool packedOverlap(PackedBounds bounds, PackedBounds query) {
  constexpr PackedBounds kHighBits = 0x8080'8080'8080'8080;
  return (((query | kHighBits) - bounds) & kHighBits) == kHighBits;
}

/// The cells of all levels, numbered consecutively.
class GridLayout {
 public:
  static constexpr int kCellBits = 6;   ///< log2 of the cell length on level 0
  static constexpr int kLevelBits = 2;  ///< log2 of the ratio between the cells of two levels
  static constexpr int kLevels = 13;    ///< the last level holds the largest boxes possible

  struct Level {
    GridCoord origin{};      ///< the first cell of the trimmed range
    GridCoord dims{};        ///< number of cells on each axis
    GridCoord max_size{};    ///< largest size of the boxes stored so far
    GridCoord strides{};     ///< from a cell's index to its neighbour's
    std::uint32_t base = 0;  ///< index of the first cell
  };

  /// The cells of a level that may store a box overlapping a query. Not wrapped.
  struct Range {
    GridCoord first;
    GridCoord last;
  };
  /// The same cells, wrapped, each of them once.
  struct WrappedRange {
    GridCoord first;   ///< relative to the level's origin
    GridCoord counts;  ///< number of cells on each axis; they wrap at the level's dims
    GridBox query;     ///< relative to the first cell
  };

  /// Chooses the quantization, the cells and the levels for these boxes. O(n).
  void fit(std::span<const Aabb> boxes);
  [[nodiscard]] std::uint32_t cellCount() const { return cell_count_; }

  [[nodiscard]] GridBox quantize(const Aabb& box) const {
    return {quantizeCorner(box.min), quantizeCorner(box.max)};
  }
  static std::uint32_t levelOf(const GridBox& box);
  [[nodiscard]] std::uint32_t cellOf(const GridBox& box, std::uint32_t level) const {
    const Level& grid = levels_[level];
    return grid.base + sumOfAxes(wrap(box.min >> cellShift(level), grid) * grid.strides);
  }
  /// kInvalidIndex if the box is empty.
  [[nodiscard]] std::uint32_t cellOf(const Aabb& box) const {
    if (isEmpty(box)) return kInvalidIndex;
    const GridBox grid_box = quantize(box);
    return cellOf(grid_box, levelOf(grid_box));
  }
  /// The bounds of `covered` relative to the cell of `box`, which `covered` contains.
  [[nodiscard]] PackedBounds packBounds(const GridBox& covered, const GridBox& box,
                                        std::uint32_t level) const;
  /// The largest packed bounds of a box that overlaps the query.
  static PackedBounds packQuery(const GridBox& in_cell) {
    return packBytes(in_cell.min, in_cell.max);
  }

  /// To be called for each box stored on the level.
  void growLevel(const GridBox& box, std::uint32_t level) {
    used_levels_ |= 1U << level;
    levels_[level].max_size = larger(levels_[level].max_size, box.size());
  }
  /// One bit per level that has ever stored a box.
  [[nodiscard]] std::uint32_t usedLevels() const { return used_levels_; }
  [[nodiscard]] const Level& level(std::uint32_t level) const { return levels_[level]; }
  /// log2 of the cell length.
  static int cellShift(std::uint32_t level) {
    return kCellBits + kLevelBits * static_cast<int>(level);
  }
  [[nodiscard]] Range queryRange(const GridBox& query, std::uint32_t level) const {
    const int shift = cellShift(level);
    return {(query.min - levels_[level].max_size) >> shift, query.max >> shift};
  }
  /// The box relative to a cell of this level, 64 units to a cell.
  static GridBox relativeToCell(GridCoord cell, const GridBox& box, std::uint32_t level) {
    const int to_level = cellShift(level) - kCellBits;
    const GridCoord begin = cell << kCellBits;
    return {(box.min >> to_level) - begin, (box.max >> to_level) - begin};
  }
  [[nodiscard]] WrappedRange wrappedRange(const GridBox& query, std::uint32_t level) const;

  /// The box of a cell that is not wrapped.
  [[nodiscard]] Aabb cellBox(GridCoord cell, std::uint32_t level) const;

 private:
  static constexpr float kMaxCoord = static_cast<float>(1 << 29);

  [[nodiscard]] GridCoord quantizeCorner(const std::array<float, 4>& corner) const {
    // A body stores an integer in the fourth component: masked out, since as a float it may be
    // denormal, and denormals hit a microcode assist.
    constexpr WholeCorner kAxes = {-1, -1, -1, 0};
    const auto on_axes = std::bit_cast<Corner>(std::bit_cast<WholeCorner>(corner) & kAxes);
    const Corner scaled = (on_axes - cornerOf(origin_)) * scale_;
    return truncated(smaller(larger(scaled, Corner{} - kMaxCoord), Corner{} + kMaxCoord));
  }
  /// Relative to the level's origin, within its dims.
  static GridCoord wrap(GridCoord cell, const Level& grid) {
    const GridCoord from_origin = cell - grid.origin;
    if (isEveryAxis((from_origin >= 0) & (from_origin < grid.dims))) [[likely]]
      return from_origin;
    return wrapOutside(from_origin, grid);
  }
  static GridCoord wrapOutside(GridCoord from_origin, const Level& grid);
  static PackedBounds packBytes(GridCoord counted_down, GridCoord counted_up);

  void chooseCellSize(std::span<const Aabb> boxes, std::span<const Aabb> sample,
                      const std::array<TrimmedRange, 3>& bulk);
  void layOutLevels(std::span<const Aabb> boxes, const std::array<TrimmedRange, 3>& bulk);

  std::array<float, 4> origin_{};
  float scale_ = 1;  ///< quantization units per world unit
  std::array<Level, kLevels> levels_;
  std::uint32_t used_levels_ = 0;
  std::uint32_t cell_count_ = 0;
};

inline std::uint32_t GridLayout::levelOf(const GridBox& box) {
  const GridCoord size = box.size();
  const std::int32_t longest =
      size[0] > size[1] ? std::max(size[0], size[2]) : std::max(size[1], size[2]);
  std::uint32_t level = 0;
  while (level + 1 < kLevels && longest > 1 << cellShift(level)) ++level;
  return level;
}

/// Saturates both at 0 and kMaxCellOffset.
inline PackedBounds GridLayout::packBytes(GridCoord counted_down, GridCoord counted_up) {
  const GridCoord from_max = kMaxCellOffset - counted_down;
#if defined(__SSE2__)
  const __m128i words =
      _mm_packs_epi32(std::bit_cast<__m128i>(from_max), std::bit_cast<__m128i>(counted_up));
  const __m128i bytes = _mm_min_epu8(_mm_packus_epi16(words, words),
                                     _mm_set1_epi8(static_cast<char>(kMaxCellOffset)));
  return std::bit_cast<std::array<PackedBounds, 2>>(bytes)[0] & 0x00FF'FFFF'00FF'FFFF;
#else
  PackedBounds bounds = 0;
  for (int axis = 0; axis < 3; ++axis) {
    bounds |= static_cast<PackedBounds>(std::clamp(from_max[axis], 0, kMaxCellOffset)) << 8 * axis;
    bounds |= static_cast<PackedBounds>(std::clamp(counted_up[axis], 0, kMaxCellOffset))
              << 8 * (axis + 4);
  }
  return bounds;
#endif
}

inline PackedBounds GridLayout::packBounds(const GridBox& covered, const GridBox& box,
                                           std::uint32_t level) const {
  const Level& grid = levels_[level];
  const GridCoord cell = box.min >> cellShift(level);
  // Queries assume that cells are not wrapped: elsewhere the bounds must overlap every query.
  const GridCoord from_origin = cell - grid.origin;
  const GridCoord is_unwrapped =
      (from_origin >= 0) & (from_origin < grid.dims) & (covered.min >> cellShift(level) == cell);
  const GridBox in_cell = relativeToCell(cell, covered, level);
  return packBytes(is_unwrapped ? in_cell.max : GridCoord{} + kMaxCellOffset,
                   is_unwrapped & in_cell.min);
}

}  // namespace broadmark::tide
