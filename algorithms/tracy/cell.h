// One cell of the grid: an incremental sweep and prune on three axes over the bodies that touch it.
//
// A cell gets the old and new boxes of its bodies, then moves the bodies sequentially. At each swap
// of one body's start with another body's end, the overlap of the two may begin or end. During the
// update some bodies are at their old and some at their new position, and a later swap may undo an
// earlier one. So a swap only triggers a test; the result depends on the old and new boxes alone,
// and each change is reported exactly once:
//
// - Two boxes overlap if, on each axis, the start of each comes before the end of the other: six
//   conditions. A start and an end are swapped at most once when the former moves and at most once
//   when the latter moves. So if a condition fails on the old boxes and holds on the new boxes, its
//   two endpoints are swapped once in that direction and never back.
// - A pair that begins to overlap has such a condition, and the swap of the first one reports it.
//   (On an axis only one of the two conditions can fail.) The same holds for a pair that ends.
// - Bodies that leave the cell are removed before the others move; bodies that enter it are
//   inserted afterwards. A query of the list of the first axis finds their pairs.
// - If two bodies share several cells, the home cell of the pair reports it: the cell with the
//   lowest corner of their intersection, the only one below which they do not both begin on any
//   axis. The home cell of the new boxes reports beginnings, that of the old boxes reports ends.
//
// Intervals are clipped to the cell: to -infinity if they begin below it, to +infinity if they end
// above it. Two bodies that touch the cell overlap on an axis exactly if their clipped intervals
// do. So a large moving body costs nothing in the cells that it spans.
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

/// Indexes arrays of two.
enum Moment : std::uint8_t { kBefore, kNow };

/// The sides on which a body extends beyond a cell that it touches: bit `axis` if it begins in a
/// lower cell, bit `axis` + 3 if it ends in a higher cell.
using Crossing = std::uint8_t;
constexpr Crossing crossesBelow(int axis) { return static_cast<Crossing>(1 << axis); }
constexpr Crossing crossesAbove(int axis) { return static_cast<Crossing>(8 << axis); }
constexpr Crossing kCrossesBelow = crossesBelow(0) | crossesBelow(1) | crossesBelow(2);
inline Crossing crossingOf(const CellRange& range, const CellPosition& cell) {
  const unsigned below = axesWhere(cornerOf(range.first) < cornerOf(cell));
  return static_cast<Crossing>(below | axesWhere(cornerOf(cell) < cornerOf(range.last)) << 3);
}

/// The bodies of the scene, as shared by all cells.
struct BodyStates {
  std::array<std::vector<Aabb>, 2> boxes;  ///< by moment; of unchanged bodies only kNow is valid
  std::array<std::vector<CellRange>, 2> ranges;  ///< by moment, as boxes
  std::vector<std::uint64_t> moved;              ///< a bit per body
  bool few_moved = false;                        ///< CellWork::moved lists the moved bodies
  CollisionFilter filter;

  [[nodiscard]] bool hasMoved(std::uint32_t body) const {
    return (moved[body / 64] >> body % 64 & 1) != 0;
  }
};

struct WorkCounts {
  std::uint64_t moves = 0;         ///< of bodies within a cell
  std::uint64_t swaps = 0;         ///< endpoints passed
  std::uint64_t cell_changes = 0;  ///< bodies that entered or left a cell
  std::uint64_t jumps = 0;         ///< bodies removed from a cell and inserted again
};

/// Input, output and scratch memory of a worker. Aligned to avoid false sharing.
struct alignas(64) CellWork {
  // Partitioned by the lower body.
  std::vector<PairBuffer> begun;
  std::vector<PairBuffer> ended;
  WorkCounts counts;

  /// Bodies of the current cell, if few bodies have moved.
  std::vector<std::uint32_t> moved;
  // Slots of the current cell.
  std::vector<std::uint32_t> leaving;
  std::vector<std::uint32_t> jumping;
  std::vector<std::uint32_t> staying;
  std::vector<std::uint32_t> entered;
  std::vector<Endpoint> endpoints;
};

class Cell {
 public:
  [[nodiscard]] std::uint32_t size() const { return size_; }

  /// Reports all pairs of the bodies. O(m log m + w), w pairs that overlap on the first axis.
  void build(const CellPosition& position, std::span<const std::uint32_t> bodies,
             const BodyStates& states, CellWork& work);

  /// Applies the moves of the bodies in the cell (with few_moved, those in work.moved) and inserts
  /// the bodies for which for_each_arrival(visit) calls visit(body).
  template <class ForEachArrival>
  void update(const BodyStates& states, CellWork& work, ForEachArrival for_each_arrival) {
    classifyMoved(states, work);
    for (const std::uint32_t slot : work.leaving) leave(slot, work);
    for (const std::uint32_t slot : work.jumping) unlink(slot, work);
    for (const std::uint32_t slot : work.staying) move(slot, work);
    for (const std::uint32_t slot : work.jumping) link(slot, work);
    for_each_arrival([&](std::uint32_t body) { enter(body, states, work); });
    endFrame(work);
    work.counts.moves += work.staying.size();
    work.counts.jumps += work.jumping.size();
    work.counts.cell_changes += work.leaving.size() + work.entered.size();
  }

  template <class Visit>
  void forEachBody(Visit visit) const {
    for (const std::uint32_t body : bodies_) {
      if (body != kEmptySlot) visit(body);
    }
  }
  /// Calls visit(lowest coordinate) for each chunk of the first axis that begins inside the cell.
  void forEachSegment(const std::function<void(float)>& visit) const;

  /// "" or the broken invariant.
  [[nodiscard]] std::string validate(const BodyStates& states) const;

 private:
  static constexpr std::uint32_t kEmptySlot = std::numeric_limits<std::uint32_t>::max();

  /// A cache line with both boxes of a body, since any event may need both.
  struct alignas(64) Slot {
    std::array<Aabb, 2> boxes;
  };
  using Crossings = std::array<Crossing, 2>;

  /// By axis: start and end.
  using Ends = std::array<std::array<Endpoint, 2>, 3>;
  [[nodiscard]] Ends ends(std::uint32_t slot, Moment) const;

  [[nodiscard]] const Aabb& box(std::uint32_t slot, Moment moment) const {
    return slots_[slot].boxes[moment];
  }
  [[nodiscard]] bool isHomeCell(std::uint32_t p, std::uint32_t q, Moment moment) const {
    return (crossings_[p][moment] & crossings_[q][moment] & kCrossesBelow) == 0;
  }

  void classifyMoved(const BodyStates& states, CellWork& work);
  void classify(std::uint32_t slot, const BodyStates& states, CellWork& work);
  [[nodiscard]] bool jumps(std::uint32_t slot) const;
  void leave(std::uint32_t slot, CellWork& work);
  void enter(std::uint32_t body, const BodyStates& states, CellWork& work);
  void unlink(std::uint32_t slot, CellWork& work);
  void link(std::uint32_t slot, CellWork& work);
  void move(std::uint32_t slot, CellWork& work);
  void endFrame(const CellWork& work);

  void moveEndpoint(int axis, Endpoint from, Endpoint to, CellWork& work);
  [[nodiscard]] bool isReportedSwap(std::uint32_t starts, std::uint32_t ends, int axis,
                                    Moment without, Moment with) const;
  void reportOverlaps(std::uint32_t slot, Moment without, Moment with,
                      std::vector<PairBuffer>& shares) const;
  void reportInitialPairs(std::span<const Endpoint> endpoints, CellWork& work) const;
  void report(std::uint32_t p, std::uint32_t q, std::vector<PairBuffer>& shares) const;

  std::uint32_t takeSlot(std::uint32_t body);
  void grow();

  CellPosition position_{};
  const CollisionFilter* filter_ = nullptr;  ///< null: every pair is wanted
  std::uint32_t size_ = 0;
  std::uint32_t capacity_ = 0;         ///< of the lists, in slots
  std::vector<std::uint32_t> bodies_;  ///< by slot
  std::vector<Slot> slots_;
  std::vector<Crossings> crossings_;  ///< by slot
  std::vector<std::uint32_t> free_;
  std::array<SegmentedList, 3> lists_ = {SegmentedList(true), SegmentedList(false),
                                         SegmentedList(false)};
};

}  // namespace broadmark::tracy
