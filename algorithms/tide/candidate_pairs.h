// Candidates for pairs where bodies creep: the pairs of boxes that are enlarged by a margin. They
// hold all overlapping pairs until a body leaves its fat box, so one search serves many frames.
//
//   fat box  +-----------+    a frame: is every moved box within its fat box still?
//            | +---+     |      yes: test the candidates with the boxes as they are
//            | |box| --> |      no:  new fat boxes, around the boxes of this frame and the last;
//            | +---+     |           search them
//            +-----------+
//
// Source: L. Verlet, "Computer Experiments on Classical Fluids", 1967 (neighbour lists).
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "broadmark/broad_phase.h"
#include "broadmark/large_array.h"

namespace broadmark::tide {

class CandidatePairs {
 public:
  /// `search` finds the candidates.
  [[gnu::cold]] CandidatePairs(std::unique_ptr<BroadPhase> search, const SceneInfo& scene,
                               const Frame& frame, ExecutionContext& execution);

  /// Starts with these boxes, and the pairs that overlap there.
  void start(std::span<const Aabb> boxes, float margin);
  /// Moves these bodies to their boxes. Returns false, and moves none, if one leaves its fat box.
  bool move(std::span<const std::uint32_t> bodies, std::span<const Aabb> boxes);
  /// Moves all bodies to these boxes, with new fat boxes.
  void restart(std::span<const Aabb> boxes, float margin);
  /// To be called after start() and restart(). O(n).
  void search();

  void findPairs(PairBuffer& pairs) const;
  /// Adds the pairs that have begun or ended to overlap since the last call.
  void findEvents(PairBuffer& began, PairBuffer& ended);

  [[nodiscard]] std::size_t size() const { return candidates_.size(); }
  [[nodiscard]] std::span<const Aabb> boxes() const { return {boxes_.data(), boxes_.size()}; }
  [[gnu::cold]] void draw(DebugDraw& draw) const;
  [[nodiscard, gnu::cold]] std::string validate() const;

 private:
  /// A pair, with kOverlaps in `b` if it overlapped when findEvents() was called last.
  using Candidate = Pair;
  static constexpr std::uint32_t kOverlaps = std::uint32_t{1} << 31;

  std::unique_ptr<BroadPhase> search_;
  std::uint32_t searches_ = 0;
  std::vector<std::uint32_t> bodies_;  ///< all ids
  LargeVector<Aabb> boxes_;
  LargeVector<Aabb> before_;  ///< before restart()
  LargeVector<Aabb> fat_boxes_;
  LargeArray<Candidate> candidates_;
};

}  // namespace broadmark::tide
