// Who lies in the cells of a loose grid.
//
// What a look into a cell costs is waiting for memory. So a cell is one cache line: of five bodies
// it has the numbers and the bounds, a byte each, which are tested together. A crowded cell has
// full lines behind its own.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "broadmark/large_array.h"
#include "tide/cells.h"

namespace broadmark::tide {

/// A cache line: of a cell, or one of those behind it, which are full.
struct alignas(64) Line {
  static constexpr std::uint32_t kPlaces = 5;
  Bounds bounds[kPlaces] = {kNobody, kNobody, kNobody, kNobody, kNobody};
  std::uint32_t bodies[kPlaces] = {kNowhere, kNowhere, kNowhere, kNowhere, kNowhere};
  std::uint32_t next = kNowhere;

  /// Where somebody is in it; kPlaces: nowhere. Without a branch, as nobody could predict the
  /// place.
  [[nodiscard]] std::uint32_t placeOf(std::uint32_t body) const {
    unsigned found = 1U << kPlaces;
    for (std::uint32_t place = 0; place < kPlaces; ++place) {
      found |= unsigned{bodies[place] == body} << place;
    }
    return static_cast<std::uint32_t>(std::countr_zero(found));
  }
  /// The bodies in it, which are in its first places.
  [[nodiscard]] std::uint32_t count() const { return placeOf(kNowhere); }
};

/// Those of the cells, then those behind them.
class Lines {
 public:
  /// Empty cells.
  void clear(std::uint32_t cells);
  /// Puts a body into a cell, where it `is_new` or gets other bounds. Nobody could predict which of
  /// both it is, so both are done alike.
  void put(std::uint32_t cell, std::uint32_t body, Bounds bounds, bool is_new) {
    Place at = {&lines_[cell], lines_[cell].placeOf(is_new ? kNowhere : body)};
    if (at.place == Line::kPlaces) [[unlikely]] {
      at = is_new ? newPlace(cell) : find(lines_[cell].next, body);
    }
    at.line->bounds[at.place] = bounds;
    at.line->bodies[at.place] = body;
  }
  /// The body lies in the cell.
  void remove(std::uint32_t cell, std::uint32_t body);

  /// So many bodies can be inserted without a line moving in memory.
  void makeRoom(std::size_t bodies);
  [[nodiscard]] const Line& operator[](std::size_t line) const { return lines_[line]; }
  [[nodiscard]] const Line* data() const { return lines_.data(); }
  [[nodiscard]] std::uint32_t numberOf(const Line* line) const {
    return static_cast<std::uint32_t>(line - lines_.data());
  }

  /// "" or what is broken; so many bodies should be there.
  [[nodiscard]] std::string validate(std::size_t bodies) const;

 private:
  struct Place {
    Line* line;
    std::uint32_t place;
  };

  Place find(std::uint32_t line, std::uint32_t body);
  Place newPlace(std::uint32_t cell);
  std::uint32_t newLine();

  std::uint32_t cells_ = 0;
  LargeArray<Line> lines_;
  std::vector<std::uint32_t> free_lines_;  ///< of these, nobody's
};

}  // namespace broadmark::tide
