// Events, for algorithms that know only the set of pairs of each frame.
//
// The pairs of a frame are sorted, by radix, and merged with those of the frame before: what is in
// one of the two lists only has begun or ended. O(k), k the pairs, shared out over the team by the
// lower body. A steady state allocates nothing.
#pragma once

#include <cstdint>
#include <memory>
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
  /// Pairs as numbers, which sort as they do.
  using Keys = std::vector<std::uint64_t>;
  /// A worker's: the pairs of its bodies.
  struct alignas(64) Part {
    std::vector<Keys> found;  ///< in the worker's share of the answer, by whose they are
    Keys now;                 ///< ascending, once sorted
    Keys before;              ///< likewise
    Keys spare;               ///< for sorting
    PairBuffer began;
    PairBuffer ended;
  };

  [[nodiscard]] std::uint64_t keyOf(Pair pair) const {
    return std::uint64_t{pair.a} << body_bits_ | pair.b;
  }
  [[nodiscard]] std::size_t ownerOf(Pair pair) const;
  void shareOut(PairRuns answer, std::size_t worker);
  void gather(std::size_t worker);
  void sort(Part& part) const;
  void compare(Part& part) const;

  std::unique_ptr<BroadPhase> algorithm_;
  ThreadTeam* team_ = nullptr;
  std::size_t bodies_ = 0;
  int body_bits_ = 0;  ///< that a body's number takes
  std::vector<Part> parts_;
  std::vector<PairRun> began_;
  std::vector<PairRun> ended_;
};

}  // namespace broadmark
