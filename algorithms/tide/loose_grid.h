// A loose grid, in which bodies are found and moved at the cost of those that move.
//
// What a move costs is waiting for memory, and branches that nobody can predict. So it touches few
// cache lines, which are sent for in time: those of the cells around it (tide/lines.h), and of the
// bodies there whose bounds pass, one each.
//
// For where bodies lie see tide/cells.h.
#pragma once

#include <array>
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
  std::uint64_t looks = 0;  ///< into the lines of eight cells, or into those behind them
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

  /// The work of a frame in which these bodies move, but not from where they are; `boxes` has one
  /// for each body.
  Work tryMoves(std::span<const std::uint32_t> bodies, std::span<const Aabb> boxes);

  /// The boxes, one per body, as of the last frame that was settled.
  void boxes(std::vector<Aabb>& into) const;

  void draw(DebugDraw& draw) const;
  /// "" or what is broken, once settled.
  [[nodiscard]] std::string validate() const;

 private:
  /// Somebody, found by a look, who may overlap a body.
  struct Candidate {
    std::uint32_t other;
    std::uint32_t line;  ///< of all looks of the batch
  };
  /// A few searches, and what is to be done for them.
  struct Batch {
    static constexpr std::size_t kSearches = 8;
    std::span<const Search> searches;
    LargeArray<Look> looks;
    LargeArray<Candidate> candidates;

    [[nodiscard]] const Look& lookOf(const Candidate& candidate) const {
      return looks[candidate.line / Look::kLines];
    }
  };
  static constexpr std::size_t kSteps = 5;  ///< that a batch takes
  /// So many searches and more touch more memory than stays in caches.
  static constexpr std::size_t kManySearches = 1000;
  /// So many searches ahead one is sent for.
  static constexpr std::size_t kSearchesAhead = 32;

  /// Somebody who has left a cell and lies there until settle(), for pairs that end there.
  struct Left {
    std::uint32_t body;
    std::uint32_t cell;
  };

  static bool overlapOnAxes(const Aabb& a, const Aabb& b) {
    return isEveryAxis((cornerOf(a.min) <= cornerOf(b.max)) & (cornerOf(b.min) <= cornerOf(a.max)));
  }
  void takeSearches(std::size_t first, Batch& batch);
  void lookAround(Batch& batch) const;
  void lookAroundFarOff(std::uint32_t level, const Extent& extent, std::uint32_t search,
                        Batch& batch) const;
  static Look& addLook(std::uint32_t search, Batch& batch);
  void addLookBehind(const Hit& followed, Batch& batch) const;
  void sendForLinesBehind(const Batch& batch) const;
  void makeMoves(const Batch& batch);
  void lookIntoCells(Batch& batch);
  void addCandidates(Batch& batch, std::size_t hits) const;
  void tellChanges(const Batch& batch, const CollisionFilter& filter, PairBuffer& began,
                   PairBuffer& ended);
  /// kBeginnings or kEnds if the overlap of both begins or ends; else 0.
  [[nodiscard]] std::uint32_t change(const Batch& batch, const Candidate& candidate) const;

  const Kernels* kernels_;
  Cells cells_;
  Lines lines_;
  LargeArray<Body> bodies_;
  LargeArray<Search> searches_;  ///< of this frame, by body
  std::array<Batch, kSteps> under_way_;
  LargeArray<Hit> hits_;
  LargeArray<Hit> followed_;  ///< looks into lines behind which there are others
  LargeArray<Left> left_;
  std::uint32_t frame_ = 1;
  Work work_;
};

}  // namespace broadmark::tide
