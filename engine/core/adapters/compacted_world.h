// Worlds that change, for algorithms that know only boxes.
//
// The bodies that take part get numbers without gaps, and the algorithm sees only these:
// O(changed bodies) a frame. Its pairs are given the bodies' own ids, and those that are not wanted
// are left out: O(pairs).
//
// What can be known of pairs beforehand keeps them from being formed. A body takes no part where no
// layer that meets its own has anybody present. Where strangers (a level, say) are near nobody that
// they meet, they take no part either: O(strangers) in a frame in which something changed. Worlds
// are put side by side.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "adapters/near_grid.h"
#include "adapters/side_by_side.h"
#include "broadmark/broad_phase.h"
#include "broadmark/non_colliding_layers.h"

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
  void drawStructure(DebugDraw& draw) const override;
  void visitCounters(const CounterVisitor& visit) const override;
  void visitSetup(const CounterVisitor& visit) const override { algorithm_->visitSetup(visit); }
  [[nodiscard]] std::string validate() const override;

 private:
  static constexpr std::uint32_t kAbsent = 0xFFFF'FFFF;

  void findStrangers(const SceneInfo& scene, std::span<const std::uint32_t> bodies);
  void takeOver(const Frame& frame);
  bool countPresent(const Frame& frame);
  void markMeeting(const Frame& frame);
  [[nodiscard]] bool takesPart(std::uint32_t body, const Aabb& box);
  void consider(std::uint32_t body, const Aabb& box);
  void place(std::uint32_t body, const Aabb& box);
  void remove(std::uint32_t place);
  void translate(PairRun found, PairBuffer& wanted) const;
  [[nodiscard]] bool isWanted(Pair places, Pair bodies) const;

  std::unique_ptr<BroadPhase> algorithm_;
  ThreadTeam* team_ = nullptr;
  float margin_ = 0;
  CollisionFilter filter_;

  // Who takes part.
  LayerMatrix matrix_;
  std::vector<std::uint8_t> present_;                           ///< by body: 1 if it is
  std::array<std::size_t, LayerMatrix::kLayers> population_{};  ///< present, by layer
  std::uint32_t meetable_ = 0;    ///< bit by layer: somebody is there whom it meets
  NonCollidingLayers strangers_;  ///< if that is worth it
  std::vector<std::uint32_t> stranger_bodies_;
  std::vector<std::uint32_t> meeting_bodies_;  ///< those that may meet strangers
  std::optional<NearGrid> near_;               ///< of these
  std::vector<std::uint32_t> appearing_;       ///< bodies that take part from this frame on

  std::optional<SideBySide> worlds_;
  std::vector<Aabb> boxes_;             ///< of those who take part, side by side, in no order
  std::vector<Aabb> true_boxes_;        ///< the same where they are, if that differs
  std::vector<std::uint32_t> bodies_;   ///< whose they are
  std::vector<std::uint32_t> places_;   ///< by body: where it is in these, or kAbsent
  std::vector<std::uint32_t> changed_;  ///< places whose boxes changed in this frame, ascending
  std::vector<PairBuffer> pairs_;       ///< a buffer for each run of the algorithm's
  std::vector<PairRun> runs_;
};

}  // namespace broadmark
