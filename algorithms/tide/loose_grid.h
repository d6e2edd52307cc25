// A loose grid, in which bodies are found and moved at the cost of those that move.
//
// What a move costs is waiting for memory, and branches that nobody can predict. So it touches few
// cache lines, which are sent for in time: those of the cells around it (tide/lines.h), and of the
// bodies there whose bounds pass, one each.
//
// For where bodies lie see tide/cells.h.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "broadmark/aabb.h"
#include "broadmark/collision_filter.h"
#include "broadmark/debug_draw.h"
#include "broadmark/execution.h"
#include "broadmark/large_array.h"
#include "broadmark/pair.h"
#include "tide/cells.h"
#include "tide/kernels.h"
#include "tide/lines.h"

namespace broadmark::tide {

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

  /// This processor must support the instruction set.
  explicit LooseGrid(Isa isa) : kernels_(&kernels(isa)) {}

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

  /// Where a body is now.
  struct Move {
    Extent to;
    std::uint32_t body;
    std::uint32_t level;
  };

  static constexpr std::uint32_t kBeginnings = 1;
  static constexpr std::uint32_t kEnds = 2;

  /// For those whose overlap with a body may change.
  struct Search {
    std::uint32_t body;
    std::uint32_t wanted;  ///< kBeginnings, kEnds or both
  };
  /// Into cells, of which these are the first lines, and what bounds must reach there. The highest
  /// byte of that is the number of a search in the batch.
  struct Looks {
    LargeArray<const Line*> cells;
    LargeArray<Bounds> least;
    std::size_t count = 0;

    void makeRoom(std::size_t more) {
      cells.resize(count + more);
      least.resize(count + more);
    }
    static constexpr int kSearchBegins = 56;  ///< bits below it
    static Bounds withSearch(Bounds least, std::size_t search) {
      return least | search << kSearchBegins;
    }
    [[nodiscard]] std::uint32_t searchOf(std::size_t look) const {
      return static_cast<std::uint32_t>(least[look] >> kSearchBegins);
    }
  };
  /// A cell on each axis, and the next one as far as it is wanted.
  struct TwoCells {
    Steps at;      ///< what it adds to the number of a cell
    Steps next;    ///< the same of the next one
    Steps is_two;  ///< -1 on axes where there is a next one, else 0
    Steps low;     ///< what is looked for, counted from the beginning of the first one
    Steps high;
  };
  /// Somebody, found in a cell, who may overlap a body.
  struct Candidate {
    const Line* cell;
    std::uint32_t other;
    std::uint32_t search;
  };
  /// A few moves, and what is to be done for them.
  struct Batch {
    static constexpr std::size_t kMoves = 4;
    std::span<const Move> moves;
    std::array<Bounds, kMoves> bounds{};  ///< what they become
    std::array<Search, 2 * kMoves> searches{};
    std::size_t search_count = 0;
    Looks looks;
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
  /// Two numbers side by side, of a cell and the next one on an axis.
  using Two = std::uint64_t __attribute__((vector_size(16)));
  static Two twice(std::uint64_t number) { return Two{number, number}; }
  static Two ofAxis(int axis, Two bounds) { return bounds & 0xFF'0000'00FF << 8 * axis; }
  /// What an axis adds to the address of a line.
  template <int axis>
  static Two bytesOf(const TwoCells& cells) {
    const auto numbers =
        __builtin_shufflevector(cells.at, cells.next, axis, axis, 4 + axis, 4 + axis);
    return (std::bit_cast<Two>(numbers) >> 32) * sizeof(Line);
  }

  void takeMoves(std::size_t first, Batch& batch);
  void prepare(Batch& batch) const;
  Bounds prepareMove(const Move& move, Batch& batch) const;
  void lookAround(Search search, const Extent& extent, Batch& batch) const;
  void lookAroundFarOff(std::uint32_t level, const Extent& extent, std::size_t search,
                        Looks& looks) const;
  void lookIntoEight(const Cells::Level& at, const TwoCells& cells, std::size_t search,
                     Looks& looks) const;
  void sendForLinesBehind(const Batch& batch) const;
  void makeMoves(const Batch& batch);
  void lookIntoCells(Batch& batch);
  void addCandidates(Batch& batch, std::size_t hits) const;
  void tellChanges(const Batch& batch, const CollisionFilter& filter, PairBuffer& began,
                   PairBuffer& ended);
  /// kBeginnings or kEnds if the overlap of both begins or ends; else 0.
  [[nodiscard]] std::uint32_t change(const Search& search, const Candidate& candidate) const;

  const Kernels* kernels_;
  Cells cells_;
  Lines lines_;
  LargeArray<Body> bodies_;
  LargeArray<Move> moves_;  ///< of this frame, by body
  std::array<Batch, kSteps> under_way_;
  LargeArray<Hit> hits_;
  LargeArray<std::uint32_t> followed_;    ///< looks into lines behind which there are others
  LargeArray<const Line*> lines_behind_;  ///< which are looked into next
  std::vector<Left> left_;
  std::uint32_t frame_ = 1;
  Work work_;
};

}  // namespace broadmark::tide
