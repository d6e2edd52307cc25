// A loose grid that finds the pairs which begin and end when some bodies move.
//
// A move is bound by memory latency and branch mispredictions. It touches few cache lines, and all
// of them are prefetched: the buckets of the cells around the body (tide/bucket_table.h), and one
// line for each body there with overlapping packed bounds.
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
#include "tide/bucket_table.h"
#include "tide/grid_layout.h"
#include "tide/kernels.h"

namespace broadmark::tide {

struct WorkCounts {
  std::uint64_t cell_queries = 0;
  std::uint64_t tests = 0;  ///< of two boxes
  std::uint64_t cell_changes = 0;
};

/// A frame: moveBodies(), findEvents(), endFrame().
class LooseGrid {
 public:
  static constexpr std::uint32_t kMaxBodies = 1U << 29;

  /// This processor must support the instruction set.
  explicit LooseGrid(Isa isa) : kernels_(&kernels(isa)) {}

  /// Fits the cells to these boxes, one per body, and stores the bodies. O(n).
  void build(std::span<const Aabb> boxes);

  /// Moves these bodies, in ascending order, to their boxes; `boxes` has one for every body.
  void moveBodies(std::span<const std::uint32_t> bodies, std::span<const Aabb> boxes);

  /// Updates the cells, and adds the wanted pairs that begin or end to overlap, each of them once.
  void findEvents(const CollisionFilter& filter, PairBuffer& began, PairBuffer& ended);

  void endFrame();

  /// Since the last reset.
  [[nodiscard]] const WorkCounts& work() const { return work_; }
  void resetWork() { work_ = {}; }

  /// The work of a frame in which these bodies move, but stay where they are.
  WorkCounts measureMoves(std::span<const std::uint32_t> bodies, std::span<const Aabb> boxes);

  /// Writes the boxes of all bodies, as of the last frame that ended.
  void copyBoxes(std::vector<Aabb>& boxes) const;

  void draw(DebugDraw& draw) const;
  /// "" or the broken invariant. Not within a frame.
  [[nodiscard, gnu::cold]] std::string validate() const;

 private:
  /// A body with packed bounds that overlap a query.
  struct Candidate {
    std::uint32_t other;
    std::uint32_t bucket;  ///< index of its query, times kBuckets, plus the bucket in the query
  };
  /// The unit of the pipeline: a few move queries, with their cell queries and candidates.
  struct Batch {
    static constexpr std::size_t kMoves = 8;
    std::span<const MoveQuery> moves;
    LargeArray<CellQuery> queries;
    LargeArray<Candidate> candidates;

    [[nodiscard]] const CellQuery& queryOf(const Candidate& candidate) const {
      return queries[candidate.bucket / CellQuery::kBuckets];
    }
  };
  static constexpr std::size_t kStages = 5;
  /// Below this number of moves the buckets stay in the caches.
  static constexpr std::size_t kMinMovesForOverflowPrefetch = 1000;
  static constexpr std::size_t kMovesAhead = 32;  ///< prefetch distance

  /// A body to be removed from its old cell in endFrame(): until then queries must find it there.
  struct Departure {
    std::uint32_t body;
    std::uint32_t cell;
  };

  // The stages, in order.
  void loadBatch(std::size_t first, Batch& batch);
  void makeQueries(Batch& batch) const;
  void prefetchOverflow(const Batch& batch) const;
  void applyMoves(const Batch& batch);
  void runQueries(Batch& batch);
  void emitEvents(const Batch& batch, const CollisionFilter& filter, PairBuffer& began,
                  PairBuffer& ended);

  void makeWrappedQueries(std::uint32_t level, const GridBox& box, std::uint32_t move,
                          Batch& batch) const;
  static CellQuery& addQuery(std::uint32_t move, Batch& batch);
  void queryOverflow(const Hit& overflow, Batch& batch) const;
  void collectCandidates(Batch& batch, std::size_t hits) const;
  [[nodiscard]] EventMask eventOf(const Batch& batch, const Candidate& candidate) const;

  const Kernels* kernels_;
  GridLayout layout_;
  BucketTable buckets_;
  LargeArray<Body> bodies_;
  LargeArray<MoveQuery> moves_;  ///< in ascending order of bodies
  std::array<Batch, kStages> pipeline_;
  LargeArray<Hit> hits_;
  LargeArray<Hit> overflows_;
  LargeArray<Departure> departures_;
  std::uint32_t frame_ = 1;
  WorkCounts work_;
};

}  // namespace broadmark::tide
