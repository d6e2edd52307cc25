// Events, for algorithms that know only the set of pairs of each frame.
//
// The pairs of a frame are sorted by their lower body, by counting, and each body's few by the
// other one; then body for body those of the two last frames are compared. O(n + k), n bodies and k
// pairs, shared out over the team by the lower body. A steady state allocates nothing.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "broadmark/broad_phase.h"

namespace broadmark {

/// Wraps an algorithm, whose answers it turns into events at the end of phase 4. A fault in an
/// answer is one of the events, too: a pair reported twice begins twice, one that is none begins in
/// every frame.
class EventsFromPairs final : public BroadPhase {
 public:
  explicit EventsFromPairs(std::unique_ptr<BroadPhase> algorithm);

  void visitParameters(const ParameterVisitor& visit) override;
  [[nodiscard]] float margin() const override { return algorithm_->margin(); }
  /// The pairs of the initial pose are found as those of a frame in which nothing changed.
  void initialize(const SceneInfo& scene, const Frame& first, Execution& execution) override;
  void updateObjects(const Frame& frame) override { algorithm_->updateObjects(frame); }
  void cleanCache() override { algorithm_->cleanCache(); }
  void updateStructures() override { algorithm_->updateStructures(); }
  void searchOverlaps() override;
  [[nodiscard]] PairRuns overlaps() const override { return algorithm_->overlaps(); }
  [[nodiscard]] PairEvents events() const override { return {began_, ended_}; }
  [[nodiscard]] TransferTimes transfers() const override { return algorithm_->transfers(); }
  void drawStructure(DebugDraw& draw) const override { algorithm_->drawStructure(draw); }
  void visitCounters(const CounterVisitor& visit) const override;
  void visitSetup(const CounterVisitor& visit) const override { algorithm_->visitSetup(visit); }
  [[nodiscard]] std::string validate() const override { return algorithm_->validate(); }

 private:
  /// Pairs by their lower body: each body's others, ascending.
  struct Groups {
    std::vector<std::size_t> begins;  ///< by group; and where the last one ends
    std::vector<std::uint32_t> others;

    [[nodiscard]] std::span<const std::uint32_t> of(std::size_t group) const {
      return std::span(others).subspan(begins[group], begins[group + 1] - begins[group]);
    }
  };
  /// A worker's: group g of worker w is body g · workers + w. Low numbers are lower bodies more
  /// often than high ones, so that each gets some of both.
  struct alignas(64) Part {
    std::vector<PairBuffer> found;  ///< in the worker's share of the answer, by whose part it is
    std::array<Groups, 2> groups;   ///< of the two last frames, taking turns
    PairBuffer began;
    PairBuffer ended;
  };

  void shareOut(PairRuns answer, std::size_t worker);
  void group(std::size_t worker);
  void compare(std::size_t worker);

  std::unique_ptr<BroadPhase> algorithm_;
  ThreadTeam* team_ = nullptr;
  std::size_t bodies_ = 0;
  std::vector<Part> parts_;
  std::size_t now_ = 0;  ///< which of the groups are this frame's
  std::vector<PairRun> began_;
  std::vector<PairRun> ended_;
};

}  // namespace broadmark
