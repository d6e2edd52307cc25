// The central interface: a broad-phase algorithm, and the layers above it for the usual cases.
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

namespace broadmark {

/// Shows one number and what it counts: "swaps", "moves", "skipped subtrees".
using CounterVisitor = std::function<void(std::string_view name, std::uint64_t count)>;

/// How much of a frame went into copying to and from a compute device, in nanoseconds.
struct TransferTimes {
  std::int64_t upload_ns = 0;
  std::int64_t download_ns = 0;
};

/// A broad-phase collision detection algorithm.
///
/// Per run: setParameters, initialize, then for every frame 1…F the four phases in the order below,
/// each timed, then overlaps(). An instance is run once, over one scene, from one thread; it may
/// use the workers of its Execution. A steady state allocates nothing.
///
/// One that knows by itself which pairs begin and end (traits.events) may be told so, by
/// reportEvents(), before initialize: then its answer is events(), and nobody asks for overlaps().
/// For all others events are made of the answers of two frames, as part of phase 4.
class BroadPhase : public Parametrised {
 public:
  /// 0: exact. Otherwise conservative: an extra pair is allowed when the two boxes overlap once
  /// each is enlarged by this much on every side (world units). Depends on the parameters alone.
  [[nodiscard]] virtual float margin() const { return 0; }

  /// Builds everything for the initial pose. `execution` outlives the instance. Throws
  /// UnsupportedError when it cannot run here.
  virtual void initialize(const SceneInfo& scene, const Frame& first,
                          ExecutionContext& execution) = 0;

  /// Phase 1: takes over the new boxes. The frame is valid only until this returns.
  virtual void updateObjects(const Frame& frame) = 0;
  /// Phase 2: drops what is left of the last frame's answer.
  virtual void cleanCache() {}
  /// Phase 3: brings the acceleration structure up to date.
  virtual void updateStructures() {}
  /// Phase 4: finds the pairs, turning a library's own pairs into ours included.
  virtual void searchOverlaps() = 0;

  /// The answer for this frame: every overlapping pair once, a < b, in any order. Owned by the
  /// algorithm; valid until the next updateObjects.
  [[nodiscard]] virtual PairRuns overlaps() const = 0;

  /// Called before initialize(), if traits.events: the answer is to be events().
  virtual void reportEvents() {}
  /// The events of this frame, in any order; after initialize() those of the initial pose, all of
  /// whose pairs began. A conservative algorithm's are those of its own set of pairs. Owned by the
  /// algorithm; valid until the next updateObjects.
  [[nodiscard]] virtual PairEvents events() const { return {}; }

  /// Copying within the phases of the last frame (algorithms on a compute device).
  [[nodiscard]] virtual TransferTimes transfers() const { return {}; }

  /// Draws the acceleration structure as it is now.
  virtual void drawStructure(DebugDraw&) const {}
  /// Shows the work counters of the last frame (incremental algorithms).
  virtual void visitCounters(const CounterVisitor&) const {}
  /// Shows what was counted once, in initialize(): the time to build kernels, for instance.
  virtual void visitSetup(const CounterVisitor&) const {}
  /// Checks the inner invariants: "" or what is broken. For tests; may be slow.
  [[nodiscard]] virtual std::string validate() const { return {}; }
};

// Three helper layers. Our families use them, too, except those that keep their pairs from frame to
// frame (KD, Tracy) and those that get all pairs at once from a compute device: for these, pair
// buffers that are emptied every frame are of no use, and they derive from BroadPhase.

/// Layer 1: keeps the execution and one pair buffer per worker, and answers with them. Phases 2 and
/// 4 are its own: an algorithm adds pairs in findPairs(), to buffers that are empty, and they are
/// the answer. An override of initialize() calls this one first; if it does not, the first search
/// throws std::logic_error.
class PairBroadPhase : public BroadPhase {
 public:
  void initialize(const SceneInfo& scene, const Frame& first, ExecutionContext& execution) override;
  void cleanCache() final;
  void searchOverlaps() final;
  [[nodiscard]] PairRuns overlaps() const final { return runs_; }

 protected:
  /// Adds every pair of the frame to the buffer of any worker.
  virtual void findPairs() = 0;

  ExecutionContext& execution() { return *execution_; }
  ThreadTeam& team() { return execution_->team(); }
  /// The pair buffer of one worker.
  PairBuffer& pairs(int worker = 0) { return buffers_[static_cast<std::size_t>(worker)]; }

 private:
  ExecutionContext* execution_ = nullptr;
  std::vector<PairBuffer> buffers_;
  std::vector<PairRun> runs_;
};

/// Layer 2: also keeps a copy of the boxes.
class BoxBroadPhase : public PairBroadPhase {
 public:
  void initialize(const SceneInfo& scene, const Frame& first, ExecutionContext& execution) override;
  void updateObjects(const Frame& frame) override;

 protected:
  [[nodiscard]] const std::vector<Aabb>& boxes() const { return boxes_; }

 private:
  std::vector<Aabb> boxes_;
};

/// Layer 2 for SIMD: keeps the copy as six arrays (structure of arrays).
class SimdBroadPhase : public PairBroadPhase {
 public:
  void initialize(const SceneInfo& scene, const Frame& first, ExecutionContext& execution) override;
  void updateObjects(const Frame& frame) override;

 protected:
  [[nodiscard]] const BoxArrays& arrays() const { return arrays_; }

 private:
  BoxArrays arrays_;
};

}  // namespace broadmark
