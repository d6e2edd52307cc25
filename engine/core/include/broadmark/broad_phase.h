// The central interface: a broad-phase algorithm, and helper base classes for common cases.
//
// Example:
//
//   class AllPairs final : public BoxBroadPhase {  // which copies the boxes
//     void findPairs() override {
//       for (std::uint32_t a = 0; a < boxes().size(); ++a) {
//         for (std::uint32_t b = a + 1; b < boxes().size(); ++b) {
//           if (broadmark::overlaps(boxes()[a], boxes()[b])) pairs().add(a, b);
//         }
//       }
//     }
//   };
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "broadmark/box_arrays.h"
#include "broadmark/debug_draw.h"
#include "broadmark/execution.h"
#include "broadmark/frame.h"
#include "broadmark/pair.h"
#include "broadmark/parameters.h"
#include "broadmark/queries.h"

namespace broadmark {

/// Receives a counter: its name ("swaps", "moves", "skipped subtrees"), borrowed for the call, and
/// its value.
using CounterVisitor = std::function<void(std::string_view name, std::uint64_t count)>;

/// Time spent in a frame on the exchange with a compute device or an external program.
struct TransferTimes {
  std::int64_t upload_ns = 0;    ///< part of the phases' times
  std::int64_t download_ns = 0;  ///< part of the phases' times
  // Of phases 1 and 4: does not count (traits.self_timed).
  std::int64_t update_overhead_ns = 0;
  std::int64_t search_overhead_ns = 0;
};

/// A broad-phase collision detection algorithm.
///
/// Per run: setParameters, initialize, then for every frame 1…F the four phases in the order below,
/// each timed, then overlaps(). An instance is run once, over one scene, from one thread; it may
/// use the workers of its ExecutionContext. A steady state allocates nothing.
///
/// An algorithm that finds begun and ended pairs itself (traits.events) may get a reportEvents()
/// call before initialize: then the answer is events(), and overlaps() is not called. For all
/// others events are derived from the answers of two frames, as part of phase 4.
///
/// An algorithm that answers queries (traits.queries) may get an answerQueries() call before
/// initialize: then phase 4 is searchQueries(). Bodies may be absent, whatever its traits say;
/// collision filters do not apply.
class BroadPhase : public Parametrised {
 public:
  /// 0: exact. Otherwise conservative: an extra pair is allowed when the two boxes overlap once
  /// each is enlarged by this much on every side (world units). Depends on the parameters alone.
  [[nodiscard]] virtual float margin() const { return 0; }

  /// Builds all structures for the initial pose. `scene` and `first` are valid only during the
  /// call, `execution` outlives the instance. Throws UnsupportedError if the algorithm cannot run
  /// here.
  virtual void initialize(const SceneInfo& scene, const Frame& first,
                          ExecutionContext& execution) = 0;

  /// Phase 1: copies the new boxes, or those that changed. The frame is valid only during the call.
  virtual void updateObjects(const Frame& frame) = 0;
  /// Phase 2: drops the last frame's answer.
  virtual void cleanCache() {}
  /// Phase 3: brings the acceleration structure up to date.
  virtual void updateStructures() {}
  /// Phase 4: finds the pairs, including the conversion of a library's own pairs.
  virtual void searchOverlaps() = 0;

  /// The answer for this frame: every overlapping pair once, a < b, in any order. Owned by the
  /// algorithm; valid until the next updateObjects.
  [[nodiscard]] virtual PairRuns overlaps() const = 0;

  /// Called before initialize() by an adapter: asks that the answer be mapped as it is found.
  /// Returns whether it will be; if not, it is mapped after the search. The map outlives the
  /// instance.
  virtual bool mapPairs(const PairMap&) { return false; }

  /// Called before initialize(), only if traits.events: the answer will be events().
  virtual void reportEvents() {}
  /// The events of this frame, in any order; after initialize() a begin event for each pair of the
  /// initial pose. A conservative algorithm reports the events of its own set of pairs. Owned by
  /// the algorithm; valid until the next updateObjects.
  [[nodiscard]] virtual PairEvents events() const { return {}; }

  /// Called before initialize(), only for kinds in traits.queries: searchQueries() replaces
  /// searchOverlaps().
  virtual void answerQueries(AnswerKind) {}
  /// Phase 4: finds the bodies that each query hits. overlaps() then holds each hit once: a, the
  /// query's index; b, the body. The batch is valid only during the call.
  virtual void searchQueries(const QueryBatch&) {}

  /// Times within the phases of the last frame (algorithms on a compute device, programs).
  [[nodiscard]] virtual TransferTimes transfers() const { return {}; }

  /// Draws the current acceleration structure. Called between frames; not timed.
  virtual void drawStructure(DebugDraw&) const {}
  /// Visits the work counters of the last frame (incremental algorithms).
  virtual void visitCounters(const CounterVisitor&) const {}
  /// Visits the counters of initialize(), such as the time to build kernels.
  virtual void visitSetup(const CounterVisitor&) const {}
  /// Checks the internal invariants: "", or the violated one. For tests; may be slow.
  [[nodiscard]] virtual std::string validate() const { return {}; }
};

// Three helper layers. The families here use them, too, except those that retain pairs between
// frames (KD, Tracy) and those that get all pairs at once from a compute device: they have no use
// for pair buffers that are emptied every frame, and derive from BroadPhase.

/// Layer 1: holds the execution context and one pair buffer per worker. Implements phases 2 and 4:
/// findPairs() adds pairs to the empty buffers, which become the answer. An override of
/// initialize() must first call this one; otherwise the first search for pairs throws
/// std::logic_error.
class PairBroadPhase : public BroadPhase {
 public:
  void initialize(const SceneInfo& scene, const Frame& first, ExecutionContext& execution) override;
  void cleanCache() final;
  void searchOverlaps() final;
  void searchQueries(const QueryBatch&) final;
  [[nodiscard]] PairRuns overlaps() const final { return runs_; }
  bool mapPairs(const PairMap& map) final {
    map_ = &map;
    return true;
  }

 protected:
  /// Adds every pair of the frame to the buffer of any worker.
  virtual void findPairs() = 0;
  /// Adds every hit of a query, as searchQueries(), to the buffer of any worker.
  virtual void findHits(const QueryBatch&) {}

  // From initialize() on.
  ExecutionContext& execution() { return *execution_; }
  ThreadTeam& team() { return execution_->team(); }
  /// The pair buffer of one worker, below execution().threads(). No other worker may use it at the
  /// same time.
  PairBuffer& pairs(int worker = 0) { return buffers_[static_cast<std::size_t>(worker)]; }

 private:
  void collectRuns();

  ExecutionContext* execution_ = nullptr;
  const PairMap* map_ = nullptr;
  std::vector<PairBuffer> buffers_;
  std::vector<PairRun> runs_;
};

/// Layer 2: also holds a copy of the boxes. Phase 1 costs O(changed bodies) if few boxes have
/// changed, otherwise O(n).
class BoxBroadPhase : public PairBroadPhase {
 public:
  void initialize(const SceneInfo& scene, const Frame& first, ExecutionContext& execution) override;
  void updateObjects(const Frame& frame) override;

 protected:
  /// The boxes of the latest frame, by body.
  [[nodiscard]] const std::vector<Aabb>& boxes() const { return boxes_; }

 private:
  std::vector<Aabb> boxes_;
};

/// Layer 2 for SIMD: the copy is stored as six arrays (structure of arrays). Phase 1 costs O(n).
class SimdBroadPhase : public PairBroadPhase {
 public:
  void initialize(const SceneInfo& scene, const Frame& first, ExecutionContext& execution) override;
  void updateObjects(const Frame& frame) override;

 protected:
  /// The boxes of the latest frame, by body.
  [[nodiscard]] const BoxArrays& arrays() const { return arrays_; }

 private:
  BoxArrays arrays_;
};

}  // namespace broadmark
