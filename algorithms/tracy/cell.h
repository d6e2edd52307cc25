// One cell of the grid: an incremental sweep and prune on three axes over the bodies that touch it.
//
// What a cell reports. A cell gets all its bodies' old and new boxes, then moves one body after the
// other. Each swap of one body's start with another's end is an event: the two may have begun or
// ceased to overlap. In the middle of a frame some bodies are at their old place and some at the
// new one, and an event may be undone by a later one. So a swap is only the occasion to test; what
// is reported depends on old and new boxes alone, and each change is reported exactly once:
//
// - On each axis, two boxes overlap if the start of each comes before the end of the other: six
//   conditions in all. A start and an end change places at most once when the one is moved and at
//   most once when the other is. So where a condition fails on the old boxes and holds on the new
//   ones, its two endpoints are swapped once in that direction and never back.
// - A pair that begins to overlap has such a condition, and is reported at the swap of the first
//   one. (On one axis only one of the two conditions can fail.) Likewise for a pair that ceases to.
// - Bodies that leave the cell go before the others move, bodies that enter it come after. Their
//   pairs are found by asking the list of the first axis which intervals they meet.
// - Of several cells that both bodies touch, the one with the lowest corner of their intersection
//   reports: the only one in which on no axis both begin below it. The beginning of an overlap is
//   reported by the cell of the new boxes, its end by that of the old ones; both bodies were in it.
//
// Intervals are clipped to the cell: what begins below it begins at -infinity, what ends above it
// ends at +infinity. Two bodies that touch the cell overlap on an axis exactly if their clipped
// intervals do. So a large body that moves costs nothing in the cells that it spans.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "broadmark/collision_filter.h"
#include "broadmark/pair.h"
#include "cell_grid.h"
#include "tracy/segmented_list.h"

namespace broadmark::tracy {

/// The two moments between which bodies move; indices of arrays.
enum Moment : std::uint8_t { kBefore, kNow };

/// Where a body pokes out of a cell that it touches: bit `axis` if it begins in a lower cell on
/// that axis, bit `axis` + 3 if it ends in a higher one.
using Crossing = std::uint8_t;
constexpr Crossing crossesBelow(int axis) { return static_cast<Crossing>(1 << axis); }
constexpr Crossing crossesAbove(int axis) { return static_cast<Crossing>(8 << axis); }
constexpr Crossing kCrossesBelow = crossesBelow(0) | crossesBelow(1) | crossesBelow(2);
inline Crossing crossingOf(const CellRange& range, const CellPosition& cell) {
  const unsigned below = axesWhere(cornerOf(range.first) < cornerOf(cell));
  return static_cast<Crossing>(below | axesWhere(cornerOf(cell) < cornerOf(range.last)) << 3);
}

/// All bodies, as far as the cells have to know them.
struct Bodies {
  std::array<std::vector<Aabb>, 2> boxes;        ///< by moment; what has not moved: kNow only
  std::array<std::vector<CellRange>, 2> ranges;  ///< likewise
  std::vector<std::uint64_t> moved;              ///< a bit per body
  bool few_moved = false;                        ///< so few that cells are told who
  CollisionFilter filter;

  [[nodiscard]] bool hasMoved(std::uint32_t body) const {
    return (moved[body / 64] >> body % 64 & 1) != 0;
  }
};

/// Work done in a frame.
struct WorkCounts {
  std::uint64_t moves = 0;         ///< of a body in a cell
  std::uint64_t swaps = 0;         ///< endpoints passed
  std::uint64_t cell_changes = 0;  ///< bodies that entered or left a cell
  std::uint64_t jumps = 0;         ///< bodies removed from a cell and inserted again
};

/// What a worker needs and brings forth. Alone on its cache lines: workers count side by side.
struct alignas(64) CellWork {
  /// Pairs that began and ceased to overlap, shared out by their lower body.
  std::vector<PairBuffer> begun;
  std::vector<PairBuffer> ended;
  WorkCounts counts;

  /// Bodies of the present cell that have moved, if few have.
  std::vector<std::uint32_t> moved;
  // Its slots.
  std::vector<std::uint32_t> leaving;
  std::vector<std::uint32_t> jumping;
  std::vector<std::uint32_t> staying;
  std::vector<std::uint32_t> entered;
  std::vector<Endpoint> endpoints;
};

class Cell {
 public:
  /// Bodies in the cell.
  [[nodiscard]] std::uint32_t size() const { return size_; }

  /// Becomes the cell at `position` with these bodies, in their boxes of now, and reports all
  /// their pairs. O(m log m + w), w the pairs that overlap on the first axis.
  void build(const CellPosition& position, std::span<const std::uint32_t> bodies, const Bodies& all,
             CellWork& work);

  /// Takes note of all bodies that have moved: those in the cell (if few, they are in work.moved)
  /// and those that enter it, which for_each_arrival(visit) shows by calling visit(body).
  template <class ForEachArrival>
  void update(const Bodies& all, CellWork& work, ForEachArrival for_each_arrival) {
    sortOutMoved(all, work);
    for (const std::uint32_t slot : work.leaving) leave(slot, work);
    for (const std::uint32_t slot : work.jumping) depart(slot, work);
    for (const std::uint32_t slot : work.staying) move(slot, work);
    for (const std::uint32_t slot : work.jumping) arrive(slot, work);
    for_each_arrival([&](std::uint32_t body) { enter(body, all, work); });
    settle(work);
    work.counts.moves += work.staying.size();
    work.counts.jumps += work.jumping.size();
    work.counts.cell_changes += work.leaving.size() + work.entered.size();
  }

  /// Calls visit(body) for all bodies in the cell.
  template <class Visit>
  void forEachBody(Visit visit) const {
    for (const std::uint32_t body : bodies_) {
      if (body != kNobody) visit(body);
    }
  }
  /// Calls visit(lowest coordinate) for each chunk of the first axis that begins inside the cell.
  void forEachSegment(const std::function<void(float)>& visit) const;

  /// "" or what is wrong.
  [[nodiscard]] std::string validate(const Bodies& all) const;

 private:
  static constexpr std::uint32_t kNobody = std::numeric_limits<std::uint32_t>::max();

  /// A body's boxes: a whole cache line, since any event may need both.
  struct alignas(64) Slot {
    std::array<Aabb, 2> boxes;
  };
  using Crossings = std::array<Crossing, 2>;

  /// Start and end on each axis.
  using Ends = std::array<std::array<Endpoint, 2>, 3>;
  [[nodiscard]] Ends ends(std::uint32_t slot, Moment) const;

  [[nodiscard]] const Aabb& box(std::uint32_t slot, Moment moment) const {
    return slots_[slot].boxes[moment];
  }
  /// Whether this cell reports the pair.
  [[nodiscard]] bool isOurs(std::uint32_t p, std::uint32_t q, Moment moment) const {
    return (crossings_[p][moment] & crossings_[q][moment] & kCrossesBelow) == 0;
  }

  void sortOutMoved(const Bodies& all, CellWork& work);
  void sortOut(std::uint32_t slot, const Bodies& all, CellWork& work);
  [[nodiscard]] bool jumps(std::uint32_t slot) const;
  void leave(std::uint32_t slot, CellWork& work);
  void enter(std::uint32_t body, const Bodies& all, CellWork& work);
  void depart(std::uint32_t slot, CellWork& work);
  void arrive(std::uint32_t slot, CellWork& work);
  void move(std::uint32_t slot, CellWork& work);
  void settle(const CellWork& work);

  void movePoint(int axis, Endpoint from, Endpoint to, CellWork& work);
  [[nodiscard]] bool reports(std::uint32_t starts, std::uint32_t ends, int axis, Moment without,
                             Moment with) const;
  void reportMeeting(std::uint32_t slot, Moment without, Moment with,
                     std::vector<PairBuffer>& shares) const;
  void reportFirstPairs(std::span<const Endpoint> endpoints, CellWork& work) const;
  void report(std::uint32_t p, std::uint32_t q, std::vector<PairBuffer>& shares) const;

  std::uint32_t takeSlot(std::uint32_t body);
  void grow();

  CellPosition position_{};
  const CollisionFilter* filter_ = nullptr;  ///< null: every pair is wanted
  std::uint32_t size_ = 0;
  std::uint32_t capacity_ = 0;         ///< slots that the lists have room for
  std::vector<std::uint32_t> bodies_;  ///< by slot, kNobody where it is free
  std::vector<Slot> slots_;
  std::vector<Crossings> crossings_;  ///< by slot
  std::vector<std::uint32_t> free_;
  std::array<SegmentedList, 3> lists_ = {SegmentedList(true), SegmentedList(false),
                                         SegmentedList(false)};
};

}  // namespace broadmark::tracy
