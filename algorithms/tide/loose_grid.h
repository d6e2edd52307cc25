// A loose grid, in which bodies are found and moved at the cost of those that move.
//
// Each body lies in one cell, by its lower corner. Cells have room for the longest edge of their
// bodies: who looks for what overlaps a box looks as far below it as these reach. There are several
// levels, each of cells four times as long as those of the one before; a body lies in the first one
// whose cells are no shorter than it is. So small and large bodies don't get in each other's way.
//
// A level has cells for the bulk of the world only. Beyond, it begins anew from the other side:
// what lies far off shares cells with others, costs tests, and needs no bounds.
//
// Coordinates are turned into whole numbers first, steps, 256 to a cell of level 0. A higher
// coordinate never gets a lower step, whatever is rounded: correctness rests on that alone.
//
// After: T. Ulrich, "Loose Octrees", Game Programming Gems, 2000; C. Ericson, "Real-Time Collision
// Detection", 2005, 7.2.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "broadmark/aabb.h"
#include "broadmark/debug_draw.h"
#include "broadmark/execution.h"
#include "corner.h"
#include "large_array.h"
#include "prefetch.h"
#include "radix_sort.h"
#include "sample.h"
#include "tide/kernels.h"

namespace broadmark::tide {

inline constexpr std::uint32_t kNowhere = std::numeric_limits<std::uint32_t>::max();

/// Where a body lies.
struct Place {
  std::uint32_t level = 0;
  std::uint32_t cell = 0;

  friend bool operator==(const Place&, const Place&) = default;
};

/// A body that moves, comes or goes in this frame.
struct Move {
  Aabb before;
  Aabb now;
  std::uint32_t body = 0;
  std::uint32_t left = kNowhere;  ///< its entry in a cell that it left, until settle()
  Place place;                    ///< now
  Place place_before;
};

/// What a frame took.
struct Work {
  std::uint64_t cells = 0;  ///< looked into
  std::uint64_t tests = 0;  ///< of a box against a body's
  std::uint64_t cell_changes = 0;
};

/// A frame: addMoves(), update(), search(), settle().
class LooseGrid {
 public:
  /// Most bodies.
  static constexpr std::uint32_t kMostBodies = 1U << 29;

  /// Moves have numbers; after `most_numbers` of them every entry is gone through once.
  explicit LooseGrid(Isa isa, std::uint32_t most_numbers = kMostBodies)
      : most_numbers_(most_numbers), kernels_(&kernels(isa)) {}

  /// Chooses cells for these boxes, one per body, and puts the bodies into them. O(n).
  void build(std::span<const Aabb> boxes);

  /// Takes over where these bodies are now; `boxes` has one for each body.
  void addMoves(std::span<const std::uint32_t> bodies, std::span<const Aabb> boxes,
                ThreadTeam& team);

  /// Puts the bodies where they are now. What has left a cell stays there, marked, until settle().
  void update();

  /// Calls began(a, b) and ended(a, b) for every pair that begins or ends to overlap, once.
  template <class Began, class Ended>
  void search(Began began, Ended ended);

  /// Ends the frame.
  void settle();

  /// The work since reset.
  [[nodiscard]] const Work& work() const { return work_; }
  void resetWork() { work_ = {}; }

  /// The boxes, one per body, as of the last frame that was settled.
  void boxes(std::vector<Aabb>& into) const;

  void draw(DebugDraw& draw) const;
  /// "" or what is broken, once settled.
  [[nodiscard]] std::string validate() const;

 private:
  static constexpr int kCellBits = 8;   ///< of the steps in a cell of level 0
  static constexpr int kLevelBits = 2;  ///< cells are 2^that times as long from level to level
  static constexpr int kLevels = 12;    ///< the last one takes the longest edges that there are
  static constexpr float kLastStep = static_cast<float>(1 << 29);

  /// Where a coordinate lies, on three axes; the fourth number means nothing.
  using Steps = std::array<std::int32_t, 4>;
  using Counts = std::array<std::int32_t, 3>;

  // The move of an entry: its number, from 1 on and higher from frame to frame, and what that means
  // for this entry. Lower numbers than this frame's mean nothing.
  static constexpr std::uint32_t kLeft = 1;  ///< it lies where the body was
  static constexpr std::uint32_t kCame = 2;  ///< it lies where the body was not
  static constexpr int kFlagBits = 2;

  /// Its entries lie side by side.
  struct Cell {
    std::uint32_t begin = 0;
    std::uint32_t count = 0;
  };

  struct Level {
    Counts first{};   ///< the cell at which the bulk begins
    Counts counts{};  ///< cells
    Counts reach{};   ///< the longest edges of bodies there were, in steps
    std::uint32_t first_cell = 0;
    std::uint32_t entries = 0;
  };

  /// Cells to look into, around a box.
  struct Cells {
    Counts first;  ///< from 0 to the number of the level's cells
    Counts counts;
    std::uint32_t level;
    std::uint32_t move;
    unsigned wanted;       ///< kBeginnings, kEnds or both
    std::size_t runs_end;  ///< its cells' entries are in runs_, up to here
  };
  static constexpr unsigned kBeginnings = 1;
  static constexpr unsigned kEnds = 2;

  static int shiftOf(std::uint32_t level) {
    return kCellBits + kLevelBits * static_cast<int>(level);
  }
  static std::uint32_t wrapped(std::int32_t cell, std::int32_t first, std::int32_t count);

  [[nodiscard]] Steps stepsOf(const std::array<float, 4>& corner) const;
  /// The moves of this frame's entries are at least this.
  [[nodiscard]] std::uint32_t moving() const { return first_number_ << kFlagBits; }
  static std::uint32_t levelOf(const Steps& min, const Steps& max);
  [[nodiscard]] Place placeOf(const Aabb& box) const;
  [[nodiscard]] Place placeOf(const Steps& min, std::uint32_t level) const;
  void reach(const Steps& min, const Steps& max, std::uint32_t level);

  void chooseSteps(std::span<const Aabb> boxes, std::span<const Aabb> sample,
                   const std::array<Bulk, 3>& bulk);
  void layOut(std::span<const Aabb> boxes, const std::array<Bulk, 3>& bulk);

  std::uint32_t newBlock(unsigned bits);
  void resizeBlock(std::uint32_t cell, unsigned bits);
  std::uint32_t insert(Place place, const Aabb& box, std::uint32_t body, std::uint32_t move);
  void remove(Place place, std::uint32_t entry);
  void relocate(std::uint32_t from, std::uint32_t to);

  void updateOne(std::uint32_t move);
  void lookAround(std::uint32_t move);
  void lookInto(Cells& cells);
  void addCells(std::uint32_t move, const Steps& min, const Steps& max, unsigned wanted);
  template <class Visit>
  static void forEachRow(const Level& level, const Cells& cells, Visit visit);
  template <class Began, class Ended>
  void test(const Cells& cells, std::span<const Run> runs, Began& began, Ended& ended);
  template <class Began, class Ended>
  void consider(const Move& move, std::uint32_t number, const Entry& entry, unsigned wanted,
                Began& began, Ended& ended) const;

  std::array<float, 4> low_{};
  float factor_ = 1;  ///< steps to a unit of length
  std::array<Level, kLevels> levels_;
  std::vector<Cell> cells_;
  /// By cell: its entries have a block of 2^that places; 0: none.
  std::vector<std::uint8_t> block_bits_;
  LargeArray<Entry> entries_;
  std::uint32_t used_ = 0;                                  ///< entries in blocks, free ones too
  std::array<std::vector<std::uint32_t>, 32> free_blocks_;  ///< by the bits of their size
  std::vector<std::uint32_t> entry_of_;                     ///< by body; kNowhere: absent
  std::vector<Move> moves_;
  RadixSorter sorter_;
  std::vector<Cells> around_;       ///< of a few moves
  std::vector<Run> runs_;           ///< the entries in these
  std::uint32_t first_number_ = 1;  ///< of this frame's moves
  std::uint32_t most_numbers_;
  const Kernels* kernels_;
  Work work_;
};

// In the header, for what is called with an event to be inlined.

inline std::uint32_t LooseGrid::wrapped(std::int32_t cell, std::int32_t first, std::int32_t count) {
  const std::uint32_t from_first =
      static_cast<std::uint32_t>(cell) - static_cast<std::uint32_t>(first);
  if (from_first < static_cast<std::uint32_t>(count)) [[likely]]
    return from_first;
  const std::int64_t rest = (std::int64_t{cell} - first) % count;
  return static_cast<std::uint32_t>(rest < 0 ? rest + count : rest);
}

inline LooseGrid::Steps LooseGrid::stepsOf(const std::array<float, 4>& corner) const {
  const Corner steps = (cornerOf(corner) - cornerOf(low_)) * factor_;
  return truncated(smaller(larger(steps, Corner{} - kLastStep), Corner{} + kLastStep));
}

template <class Visit>
void LooseGrid::forEachRow(const Level& level, const Cells& cells, Visit visit) {
  const auto following = [&](std::int32_t cell, int axis) {
    return cell + 1 == level.counts[axis] ? 0 : cell + 1;
  };
  std::int32_t z = cells.first[2];
  for (std::int32_t k = 0; k < cells.counts[2]; ++k, z = following(z, 2)) {
    std::int32_t y = cells.first[1];
    for (std::int32_t j = 0; j < cells.counts[1]; ++j, y = following(y, 1)) {
      const std::int64_t row = (std::int64_t{z} * level.counts[1] + y) * level.counts[0];
      visit(level.first_cell + static_cast<std::size_t>(row));
    }
  }
}

template <class Began, class Ended>
void LooseGrid::search(Began began, Ended ended) {
  // Memory is waited for once in each step of a batch, and not for each move.
  constexpr std::uint32_t kBatch = 16;
  const auto count = static_cast<std::uint32_t>(moves_.size());
  for (std::uint32_t first = 0; first < count; first += kBatch) {
    const std::uint32_t last = std::min(first + kBatch, count);
    around_.clear();
    runs_.clear();
    for (std::uint32_t move = first; move < last; ++move) lookAround(move);
    for (Cells& cells : around_) lookInto(cells);
    std::size_t run = 0;
    for (const Cells& cells : around_) {
      test(cells, std::span(runs_).subspan(run, cells.runs_end - run), began, ended);
      run = cells.runs_end;
    }
  }
}

template <class Began, class Ended>
void LooseGrid::test(const Cells& cells, std::span<const Run> runs, Began& began, Ended& ended) {
  const Move& move = moves_[cells.move];
  // What does not overlap this concerns nobody.
  const Aabb hull = cells.wanted == kBeginnings ? move.now
                    : cells.wanted == kEnds     ? move.before
                                                : merged(move.before, move.now);
  std::array<const Entry*, kMostHits + 1> hits;
  const Run* const end = runs.data() + runs.size();
  for (const Run* first = runs.data(); first != end;) {
    std::uint32_t entries = first->count;
    const Run* last = first + 1;
    for (; last != end && entries + last->count <= kMostHits; ++last) entries += last->count;
    work_.tests += entries;
    const std::size_t count = kernels_->find_hits(first, last, hull, moving(), hits.data());
    for (std::size_t i = 0; i < count; ++i) {
      consider(move, first_number_ + cells.move, *hits[i], cells.wanted, began, ended);
    }
    first = last;
  }
}

/// Two bodies that both move are a pair of the one that comes first.
template <class Began, class Ended>
void LooseGrid::consider(const Move& move, std::uint32_t number, const Entry& entry,
                         unsigned wanted, Began& began, Ended& ended) const {
  bool was = false;
  bool is = false;
  const std::uint32_t other = entry.move() >> kFlagBits;
  unsigned flags = 0;
  if (other < first_number_) {
    was = overlaps(move.before, entry.box);
    is = overlaps(move.now, entry.box);
  } else {
    if (other <= number) return;
    const Move& its = moves_[other - first_number_];
    was = overlaps(move.before, its.before);
    is = overlaps(move.now, its.now);
    flags = entry.move();
  }
  if (was == is) return;
  // An entry that the other left tells of ends only, one where it came of beginnings only.
  if (is && (wanted & kBeginnings) != 0 && (flags & kLeft) == 0) began(move.body, entry.body());
  if (was && (wanted & kEnds) != 0 && (flags & kCame) == 0) ended(move.body, entry.body());
}

}  // namespace broadmark::tide
