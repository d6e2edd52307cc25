// A loose grid, in which bodies are found and moved at the cost of those that move.
//
// Each body lies in one cell, by its lower corner. Cells have room for the longest edge of their
// bodies: who looks for what overlaps a box looks as far below it as these reach. There are several
// levels, each of cells four times as long as those of the one before; a body lies in the first one
// whose cells are no shorter than it is. So small and large bodies don't get in each other's way.
//
// What a move costs is waiting for memory, and branches that nobody can predict. So a cell is one
// cache line: of five bodies it has the numbers and the bounds, a byte each, which are tested
// together. Their boxes are in an array by body, a line each, and looked at for the few that pass.
// A crowded cell has full lines behind its own.
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
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "broadmark/aabb.h"
#include "broadmark/collision_filter.h"
#include "broadmark/debug_draw.h"
#include "broadmark/large_array.h"
#include "broadmark/pair.h"
#include "corner.h"
#include "prefetch.h"
#include "sample.h"

namespace broadmark::tide {

inline constexpr std::uint32_t kNowhere = std::numeric_limits<std::uint32_t>::max();

/// What a frame took.
struct Work {
  std::uint64_t lines = 0;  ///< cache lines of cells that were looked into
  std::uint64_t tests = 0;  ///< of a box against another body's
  std::uint64_t cell_changes = 0;
};

/// A frame: addMoves(), search(), settle().
class LooseGrid {
 public:
  /// Most bodies.
  static constexpr std::uint32_t kMostBodies = 1U << 29;

  /// Chooses cells for these boxes, one per body, and puts the bodies into them. O(n).
  void build(std::span<const Aabb> boxes);

  /// Takes over where these bodies are now, ascending; `boxes` has one for each body.
  void addMoves(std::span<const std::uint32_t> bodies, std::span<const Aabb> boxes);

  /// Moves them to other cells, and adds the wanted pairs that begin or end to overlap, once each.
  void search(const CollisionFilter& filter, PairBuffer& began, PairBuffer& ended);

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
  static constexpr int kCellBits = 6;   ///< of the steps in a cell of level 0
  static constexpr int kLevelBits = 2;  ///< cells are 2^that times as long from level to level
  static constexpr int kLevels = 13;    ///< the last one takes the longest edges that there are
  static constexpr float kLastStep = static_cast<float>(1 << 29);

  /// Where a coordinate lies, on three axes; the fourth number means nothing.
  using Steps = WholeCorner;

  /// A box in steps.
  struct Extent {
    Steps min;
    Steps max;
    [[nodiscard]] Steps edges() const { return max - min; }
  };

  /// Of a box in a cell: a byte for its upper bound on each axis, counted from the cell's
  /// beginning, one that is 1, and on each axis a byte for its lower bound, counted down from
  /// kLastInCell. All are at most kLastInCell, and the bit above that is set. Of a box that is
  /// looked for: what these must reach for the two to overlap, without that bit.
  using Bounds = std::uint64_t;
  static constexpr std::int32_t kLastInCell = 127;  ///< a loose cell is as long as two
  static constexpr Bounds kNobody = 0x0080'8080'8080'8080;
  static constexpr Bounds kSomebody = Bounds{1} << 24;

  /// A byte that is too small takes its highest bit away.
  static bool reaches(Bounds bounds, Bounds least) {
    return ((bounds - least) & kNobody) == kNobody;
  }

  /// A cache line: of a cell, or one of those behind it, which are full.
  struct alignas(64) Line {
    static constexpr std::uint32_t kPlaces = 5;
    std::array<Bounds, kPlaces> bounds{kNobody, kNobody, kNobody, kNobody, kNobody};
    std::array<std::uint32_t, kPlaces> bodies{kNowhere, kNowhere, kNowhere, kNowhere, kNowhere};
    std::uint32_t next = kNowhere;

    /// The bodies in it, which are in its first places.
    [[nodiscard]] std::uint32_t count() const {
      return static_cast<std::uint32_t>(kPlaces - std::ranges::count(bounds, kNobody));
    }
    /// A bit for each place whose bounds reach these.
    [[nodiscard]] unsigned placesThatReach(Bounds least) const;
  };
  struct Place {
    Line* line;
    std::uint32_t place;
  };

  /// A cache line, too: where a body is, and where it was before its last move. The fourth
  /// components have the frame of that, and cells.
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

  struct Level {
    Steps first{};    ///< the cell at which the bulk begins
    Steps counts{};   ///< cells
    Steps reach{};    ///< the longest edges of bodies there were, in steps
    Steps strides{};  ///< from one cell to the next
    std::uint32_t first_cell = 0;
  };

  static constexpr std::uint32_t kBeginnings = 1;
  static constexpr std::uint32_t kEnds = 2;

  /// The cells of a level where somebody may overlap an extent.
  struct Surroundings {
    Steps first;   ///< counted from the level's first cell; beyond the last one they begin anew
    Steps counts;  ///< how many on each axis
    Steps low;     ///< the extent, counted from the beginning of the first one
    Steps high;
  };
  /// Into a cell, for those whose overlap with a body may change.
  struct Look {
    Bounds least;
    std::uint32_t cell;
    std::uint32_t body;
    std::uint32_t wanted;  ///< kBeginnings, kEnds or both
  };
  /// The bodies in some places of a line, met by a look.
  struct Hit {
    const Line* line;
    std::uint32_t look;
    unsigned places;  ///< a bit each
  };
  /// Somebody, found in a cell, who may overlap a body.
  struct Candidate {
    std::uint32_t other;
    std::uint32_t cell;
    std::uint32_t body;
    std::uint32_t wanted;
  };
  /// A few moves, and what is to be done for them.
  struct Batch {
    static constexpr std::size_t kMoves = 4;
    std::span<const std::uint32_t> moves;
    std::array<Bounds, kMoves> bounds{};  ///< what they become
    LargeArray<Look> looks;
    LargeArray<Candidate> candidates;
  };
  static constexpr std::size_t kSteps = 5;  ///< that a batch takes
  /// So many moves and more touch more memory than stays in caches.
  static constexpr std::size_t kManyMoves = 1000;

  /// Somebody who has left a cell and lies there until settle(), for pairs that end there.
  struct Left {
    std::uint32_t body;
    std::uint32_t cell;
  };

  static bool overlapOnAxes(const Aabb& a, const Aabb& b) {
    return isEveryAxis((cornerOf(a.min) <= cornerOf(b.max)) & (cornerOf(b.min) <= cornerOf(a.max)));
  }
  static int shiftOf(std::uint32_t level) {
    return kCellBits + kLevelBits * static_cast<int>(level);
  }
  /// Counted from the first cell on each axis; those beyond the last ones begin anew.
  static Steps wrapped(Steps cells, const Level& at);
  static Bounds boundsOnAxes(Steps low, Steps high);
  static Bounds ofAxis(int axis, Bounds bounds) { return bounds & 0xFF'0000'00FF << 8 * axis; }

  [[nodiscard]] Steps stepsOf(const std::array<float, 4>& corner) const;
  [[nodiscard]] Extent extentOf(const Aabb& box) const {
    return {stepsOf(box.min), stepsOf(box.max)};
  }
  static std::uint32_t levelOf(const Extent& extent);
  [[nodiscard]] std::uint32_t cellOf(const Extent& extent, std::uint32_t level) const;
  /// kNowhere if the box is empty.
  [[nodiscard]] std::uint32_t cellOf(const Aabb& box) const {
    if (isEmpty(box)) return kNowhere;
    const Extent extent = extentOf(box);
    return cellOf(extent, levelOf(extent));
  }
  [[nodiscard]] Bounds boundsOf(const Extent& extent, const Extent& body) const;
  void reach(const Extent& extent, std::uint32_t level);

  void chooseSteps(std::span<const Aabb> boxes, std::span<const Aabb> sample,
                   const std::array<Bulk, 3>& bulk);
  void chooseCells(std::span<const Aabb> boxes, const std::array<Bulk, 3>& bulk);
  void putInto(std::span<const Aabb> boxes);

  std::uint32_t newLine();
  Place find(std::uint32_t cell, std::uint32_t body);
  void insert(std::uint32_t cell, std::uint32_t body, Bounds bounds);
  void remove(std::uint32_t cell, std::uint32_t body);

  void takeMoves(std::size_t first, Batch& batch);
  void prepare(Batch& batch);
  Bounds prepareMove(std::uint32_t body, LargeArray<Look>& looks);
  void lookAround(std::uint32_t body, const Extent& extent, std::uint32_t wanted,
                  LargeArray<Look>& looks);
  static Surroundings surroundings(const Level& at, int shift, const Extent& extent);
  Look* lookIntoEight(const Level& at, const Surroundings& around, Steps offset, Look as,
                      Look* looks) const;
  void sendForLinesBehind(const Batch& batch) const;
  void makeMoves(const Batch& batch);
  void lookIntoCells(Batch& batch);
  void addCandidates(Batch& batch, std::size_t hits) const;
  void tellChanges(const Batch& batch, const CollisionFilter& filter, PairBuffer& began,
                   PairBuffer& ended);
  /// kBeginnings or kEnds if the overlap of both begins or ends; else 0.
  [[nodiscard]] std::uint32_t change(const Candidate& candidate) const;

  std::array<float, 4> low_{};
  float factor_ = 1;  ///< steps to a unit of length
  std::array<Level, kLevels> levels_;
  std::uint32_t used_levels_ = 0;  ///< a bit for each level where there has been somebody
  std::uint32_t cell_count_ = 0;
  LargeArray<Line> lines_;                 ///< of the cells, then those behind them
  std::vector<std::uint32_t> free_lines_;  ///< of these, nobody's
  LargeArray<Body> bodies_;
  std::vector<std::uint32_t> moves_;  ///< the bodies of this frame's moves, ascending
  std::array<Batch, kSteps> under_way_;
  LargeArray<Hit> hits_;
  std::vector<Left> left_;
  std::uint32_t frame_ = 1;
  Work work_;
};

}  // namespace broadmark::tide
