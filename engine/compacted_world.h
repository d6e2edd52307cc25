// Worlds that change, for algorithms that know only boxes.
//
// The bodies that are present get numbers without gaps, and the algorithm sees only these:
// O(changed bodies) a frame. Its pairs are given the bodies' own ids, and those that are not wanted
// are left out: O(pairs).
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "broadmark/broad_phase.h"

namespace broadmark {

/// Wraps an algorithm whose frames may each have another number of bodies.
class CompactedWorld final : public BroadPhase {
 public:
  explicit CompactedWorld(std::unique_ptr<BroadPhase> algorithm);

  void visitParameters(const ParameterVisitor& visit) override;
  [[nodiscard]] float margin() const override { return algorithm_->margin(); }
  void initialize(const SceneInfo& scene, const Frame& first, Execution& execution) override;
  void updateObjects(const Frame& frame) override;
  void cleanCache() override;
  void updateStructures() override { algorithm_->updateStructures(); }
  void searchOverlaps() override;
  [[nodiscard]] PairRuns overlaps() const override { return runs_; }
  [[nodiscard]] TransferTimes transfers() const override { return algorithm_->transfers(); }
  void drawStructure(DebugDraw& draw) const override { algorithm_->drawStructure(draw); }
  void visitCounters(const CounterVisitor& visit) const override;
  void visitSetup(const CounterVisitor& visit) const override { algorithm_->visitSetup(visit); }
  [[nodiscard]] std::string validate() const override;

 private:
  static constexpr std::uint32_t kAbsent = 0xFFFF'FFFF;

  void takeOver(const Frame& frame);
  void place(std::uint32_t body, const Aabb& box);
  void remove(std::uint32_t place);
  void translate(PairRun found, PairBuffer& wanted) const;

  std::unique_ptr<BroadPhase> algorithm_;
  ThreadTeam* team_ = nullptr;
  CollisionFilter filter_;
  std::vector<Aabb> boxes_;             ///< of the bodies that are present, in no order
  std::vector<std::uint32_t> bodies_;   ///< whose they are
  std::vector<std::uint32_t> places_;   ///< by body: where it is in these two, or kAbsent
  std::vector<std::uint32_t> changed_;  ///< places whose boxes changed in this frame, ascending
  std::vector<PairBuffer> pairs_;       ///< a buffer for each run of the algorithm's
  std::vector<PairRun> runs_;
};

}  // namespace broadmark
