// The way through the columns: one after the other is put in order, in memory that stays in the
// caches, and shown to a visitor. Crowded ones are cut into columns of their own, as if each were a
// world, and these are gone through in their place.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "broadmark/aabb.h"
#include "columns/chains.h"
#include "columns/copies.h"
#include "columns/kernels.h"
#include "columns/layout.h"

namespace broadmark::columns {

/// A part of the work in a world or in a column: from where to where, 0 to 1.
struct Part {
  double from = 0;
  double to = 1;
};

/// A world, or a column that is cut like one: where its columns lie, and what is in them. Each of
/// several workers has filled chains of its own, one after the other in the order of the bodies.
struct CutWorld {
  Layout layout;
  std::span<const Chains> chains;

  /// The copies in a column.
  [[nodiscard]] std::size_t count(std::size_t column) const {
    std::size_t copies = 0;
    for (const Chains& each : chains) copies += each.count(column);
    return copies;
  }
  /// Calls visit(copy) for each of them.
  template <class Visit>
  void forEachCopy(std::size_t column, Visit visit) const {
    for (const Chains& each : chains) each.forEach(column, visit);
  }
};

class Walk;

/// Is shown what a walk comes to.
class ColumnVisitor {
 public:
  virtual ~ColumnVisitor() = default;
  /// A part of a column: walk.sorted() is what is in it.
  virtual void column(Walk& walk, const Part& part) = 0;
  /// A part of a column that is cut, `inside`, and will be gone through. walk.sorted() is the
  /// whole.
  virtual void split(const Walk& /*walk*/, const CutWorld& /*inside*/, const Part& /*part*/) {}
};

/// Goes through columns. It keeps its memory; each worker has one.
class Walk {
 public:
  /// Columns are cut, and cut again, at most so often.
  static constexpr int kMostLevels = 8;
  /// What is cut, the world included, gets at most so many copies of each box on average.
  static constexpr std::size_t kMostCopies = 4;

  /// What it goes through the columns of. All is borrowed.
  struct Boxes {
    const Kernels* kernels = nullptr;
    std::span<const Aabb> boxes;
    double copy_cost = 0;       ///< in tests of a pair
    std::uint64_t crowded = 0;  ///< tests per copy from which on a column is cut, if that helps
  };

  /// Goes through a part of a world's columns. The parts of several walks, put together, are the
  /// whole; a column that lies in two of them is put in order by both.
  void go(const Boxes& boxes, const CutWorld& world, const Part& part, ColumnVisitor& visitor);

  /// The column at hand.
  [[nodiscard]] const Sorted& sorted() const { return sorted_; }
  /// Whether it has more tests per copy than it should.
  [[nodiscard]] bool crowded() const { return sorted_.tests > boxes_.crowded * sorted_.size; }
  /// Sends for some of the next one, which takes its time. To be called now and then.
  void sendForMore() { ahead_.more(); }
  /// In how many columns that are cut it lies.
  [[nodiscard]] int level() const { return level_; }
  /// The box of the column at hand, in the world's bounds.
  [[nodiscard]] Aabb box(const Aabb& bounds) const;

 private:
  void goThrough(const CutWorld& world, const Part& part);
  void order(const CutWorld& world, std::size_t column, std::size_t count);
  bool split(const Part& part);
  bool fill(const Layout& layout, Chains& chains);
  /// What a column of so many copies costs, in tests, as far as that can be told beforehand.
  [[nodiscard]] double workOf(const Layout& layout, std::size_t copies) const;

  /// Where the column at hand lies: in each world that it is in, from the outermost on.
  struct Place {
    const Layout* layout;
    std::size_t column;
  };

  Boxes boxes_;
  ColumnVisitor* visitor_ = nullptr;
  Sorted sorted_;
  ChainsAhead ahead_;                  ///< of the next column
  std::vector<std::uint32_t> places_;  ///< per bucket of the column at hand
  std::vector<Aabb> sample_;
  int level_ = 0;
  std::array<Place, kMostLevels> path_{};
  std::array<Chains, kMostLevels> chains_;  ///< of what is cut, by level
};

/// Calls visit(k) for each box of a set.
template <class Visit>
inline void forEachBox(const BoxBlock::Set& set, Visit visit) {
  std::size_t word = 0;
  for (std::uint64_t bits : set) {
    for (; bits != 0; bits &= bits - 1) {
      visit(64 * word + static_cast<std::size_t>(std::countr_zero(bits)));
    }
    ++word;
  }
}

/// Calls visit(column, copy) for every column that the boxes of a block touch beside their first
/// ones. Few boxes touch others, and most of those that do touch one.
template <class Visit>
inline void forEachOtherCopy(const Layout& layout, const BoxBlock& block, Visit visit) {
  constexpr int kBits = Layout::kStepBits;
  constexpr std::uint32_t kLast = Layout::kLastStep;
  // Marks are by axis: columns within a column may be cut on other axes than it.
  const MarkedBody mark_a = axisMark(layout.scales().of[0].axis);
  const MarkedBody mark_b = axisMark(layout.scales().of[1].axis);
  forEachBox(block.cross_one, [&](std::size_t k) {
    Copy copy = block.copies[k];
    copy.key = block.next_keys[k];
    copy.body = block.next_bodies[k];
    visit(block.next_columns[k], copy);
  });
  forEachBox(block.cross_more, [&](std::size_t k) {
    Copy copy = block.copies[k];
    const MarkedBody body = copy.body;
    const std::uint32_t low_a = block.low[0][k];
    const std::uint32_t low_b = block.low[1][k];
    const std::uint32_t high_a = block.high[0][k];
    const std::uint32_t high_b = block.high[1][k];
    for (std::uint32_t b = low_b >> kBits; b <= high_b >> kBits; ++b) {
      const bool later_b = b != low_b >> kBits;
      const std::uint32_t first_b = later_b ? 0 : low_b & kLast;
      const std::uint32_t last_b = b != high_b >> kBits ? kLast : high_b & kLast;
      const std::uint32_t first_column = low_a >> kBits;
      for (std::uint32_t a = first_column + (later_b ? 0 : 1); a <= high_a >> kBits; ++a) {
        const bool later_a = a != first_column;
        const std::uint32_t first_a = later_a ? 0 : low_a & kLast;
        const std::uint32_t last_a = a != high_a >> kBits ? kLast : high_a & kLast;
        copy.key = keyOf(first_a, first_b, last_a, last_b);
        copy.body = body | (later_a ? mark_a : 0) | (later_b ? mark_b : 0);
        visit(layout.indexOf(a, b), copy);
      }
    }
  });
}

/// Adds the copies of a block of boxes to the chains of the columns that they touch. Returns how
/// many.
inline std::size_t appendCopies(const Layout& layout, const BoxBlock& block, std::size_t count,
                                Chains& chains) {
  chains.append(block.columns, block.copies, count);
  forEachOtherCopy(layout, block, [&](std::size_t column, const Copy& copy) {
    chains.append(column, copy);
    ++count;
  });
  return count;
}

}  // namespace broadmark::columns
