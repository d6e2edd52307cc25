// Searches for those whose overlap with a body that moves may change, and looks into cells for
// them.
//
// As a rule a box has two cells on each axis around it, so a look is into eight cells at once, of
// which those that are not wanted stand for the first one.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>

#include "broadmark/aabb.h"
#include "corner.h"
#include "tide/cells.h"
#include "tide/lines.h"

namespace broadmark::tide {

/// A cache line: where a body is, and where it was before its last move. The fourth components
/// have the frame of that, and cells.
struct alignas(64) Body {
  Aabb box;
  Aabb before;

  [[nodiscard]] std::uint32_t frame() const { return std::bit_cast<std::uint32_t>(box.min[3]); }
  /// kNowhere: it is absent.
  [[nodiscard]] std::uint32_t cell() const { return std::bit_cast<std::uint32_t>(box.max[3]); }
  [[nodiscard]] std::uint32_t cellBefore() const {
    return std::bit_cast<std::uint32_t>(before.max[3]);
  }
  void move(const Aabb& to, std::uint32_t to_cell, std::uint32_t in_frame) {
    before = box;
    box = to;
    box.min[3] = std::bit_cast<float>(in_frame);
    box.max[3] = std::bit_cast<float>(to_cell);
  }
};

inline constexpr std::uint32_t kBeginnings = 1;
inline constexpr std::uint32_t kEnds = 2;

/// For those whose overlap with a body that moves may change. A body that has moved far has two,
/// one behind the other: around where it was, and around where it is.
struct alignas(64) Search {
  Extent around;
  Bounds bounds;  ///< of the body, from now on
  std::uint32_t body;
  std::uint32_t wanted;  ///< kBeginnings, kEnds or both
  std::uint32_t cell;    ///< of the body: kNowhere if it is absent
  std::uint32_t cell_before;
};

/// Into the lines of two cells on each axis, or into those behind them.
struct alignas(64) Look {
  static constexpr std::uint32_t kLines = 8;
  /// Of a byte for each line: a bit for each place, and one that says that there are lines behind.
  static constexpr std::uint64_t kPlaces = 0x1F1F'1F1F'1F1F'1F1F;
  static constexpr std::uint64_t kFollowed = 0x8080'8080'8080'8080;
  static constexpr std::uint64_t kLine = (kPlaces | kFollowed) & 0xFF;  ///< all of the first one's

  const Line* lines[kLines];
  Bounds limits[kLines];   ///< for the bodies that are looked for
  std::uint64_t wanted;    ///< a byte for each line, 0 if it is not
  std::uint32_t search;    ///< within the batch
  std::uint32_t of_cells;  ///< the look into the cells that these lines are those of
};

/// Eight numbers, one for each line.
using Eight = std::uint64_t __attribute__((vector_size(64)));

/// Two cells on each axis.
struct EightCells {
  const Line* first;
  Steps next;     ///< on each axis, how many lines behind the first one the second one is
  Steps is_two;   ///< -1 on axes where it is wanted, else 0
  Extent extent;  ///< what is looked for, counted from the beginning of the first one
};

/// All of a look but `search` and `of_cells`. Inlined, to be compiled for a kernel's instruction
/// set.
[[gnu::always_inline]] inline void setLines(const EightCells& cells, Look& look) {
  constexpr std::uint64_t kAll = ~std::uint64_t{0};
  constexpr Eight kSecond[3] = {{0, kAll, 0, kAll, 0, kAll, 0, kAll},
                                {0, 0, kAll, kAll, 0, 0, kAll, kAll},
                                {0, 0, 0, 0, kAll, kAll, kAll, kAll}};
  constexpr std::uint64_t kOfAxis = 0xFF'0000'00FF;
  static constexpr auto kWanted = [] {
    std::array<std::uint64_t, 8> wanted{};
    for (unsigned axes = 0; axes < 8; ++axes) {
      for (unsigned line = 0; line < Look::kLines; ++line) {
        if ((line & ~axes) == 0) wanted[axes] |= Look::kLine << 8 * line;
      }
    }
    return wanted;
  }();
  static_assert(sizeof(std::uintptr_t) == sizeof(std::uint64_t));

  constexpr std::int32_t kCell = 1 << Cells::kCellBits;
  const Bounds here = Cells::limitsOf(cells.extent);
  const Bounds there = Cells::limitsOf({cells.extent.min - kCell, cells.extent.max - kCell});
  Eight lines = Eight{} + reinterpret_cast<std::uintptr_t>(cells.first);
  Eight is_second{};
  for (int axis = 0; axis < 3; ++axis) {
    lines +=
        kSecond[axis] & static_cast<std::uint64_t>(cells.next[axis] * std::int64_t{sizeof(Line)});
    is_second |= kSecond[axis] & kOfAxis << 8 * axis;
  }
  const Eight limits = (~is_second & here) | (is_second & there);
  std::memcpy(look.lines, &lines, sizeof(lines));
  std::memcpy(look.limits, &limits, sizeof(limits));
  look.wanted = kWanted[axesWhere(cells.is_two)];
}

}  // namespace broadmark::tide
