// Several worlds at one place, for algorithms that would mix their bodies up in one structure.
//
// Each world has an instance of the algorithm, which knows of no other: its bodies have numbers
// without gaps, in the order of their ids, and of the collision filter it sees layers and tags. A
// frame costs O(changed bodies), what the instances of the worlds take in which something changed,
// and O(their pairs) to give these the bodies' own ids. The other worlds keep their answers.
//
// While a world is in the caches its instance goes through all of its phases: they count as phase
// 4, and the copying of boxes as phase 1. World after world for each phase, many small ones took up
// to 1.3 times as long.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "broadmark/broad_phase.h"

namespace broadmark {

/// Wraps the instances. A team of several workers gets a fixed share of the worlds for each; where
/// the worlds are fewer than the workers, they come one after the other, each for the whole team.
class WorldsApart final : public BroadPhase {
 public:
  /// Makes an instance for a scene that is one world, with the case's parameters.
  using Maker = std::function<std::unique_ptr<BroadPhase>(const SceneInfo& world)>;

  /// Makes the instances. With `concurrent`, several may be called at once.
  WorldsApart(const SceneInfo& scene, const Maker& make, bool concurrent);

  [[nodiscard]] float margin() const override;
  void initialize(const SceneInfo& scene, const Frame& first, Execution& execution) override;
  void updateObjects(const Frame& frame) override;
  void searchOverlaps() override;
  [[nodiscard]] PairRuns overlaps() const override { return runs_; }
  void reportEvents() override;
  [[nodiscard]] PairEvents events() const override { return {began_, ended_}; }
  [[nodiscard]] TransferTimes transfers() const override;
  void drawStructure(DebugDraw& draw) const override;
  /// Sums over the worlds in which something changed.
  void visitCounters(const CounterVisitor& visit) const override;
  /// Sums over all worlds.
  void visitSetup(const CounterVisitor& visit) const override;
  [[nodiscard]] std::string validate() const override;

 private:
  /// One world. On cache lines of its own: its neighbours may be another worker's.
  struct alignas(64) World {
    std::uint32_t number = 0;           ///< as the filter has it
    std::vector<std::uint32_t> bodies;  ///< their ids, ascending
    SceneInfo scene;
    std::unique_ptr<BroadPhase> instance;
    Execution* execution = nullptr;
    std::uint32_t index = 0;  ///< of the instance's frame: it sees only those with changes
    std::vector<Aabb> boxes;
    std::vector<std::uint32_t> changed;  ///< positions in these, ascending
    std::vector<Pair> pairs;             ///< by the bodies' ids
    std::vector<Pair> began;
    std::vector<Pair> ended;

    [[nodiscard]] Frame frame() const { return {index, boxes, changed}; }
    void translate(PairRuns found, std::vector<Pair>& into) const;
    void takeEvents();
  };
  /// A body's world and its position there.
  struct Place {
    std::uint32_t world = 0;
    std::uint32_t body = 0;
  };

  template <class Call>
  void forEachActive(Call call);
  void shareOut(Execution& execution);
  void gatherEvents();

  ThreadTeam* team_ = nullptr;  ///< if the worlds are shared out over its workers
  std::vector<std::unique_ptr<Execution>> executions_;  ///< then: one for each of these
  std::vector<World> worlds_;                           ///< those of two bodies or more, by number
  std::vector<Place> places_;                           ///< by body
  bool concurrent_;
  bool reports_events_ = false;
  std::vector<std::uint32_t> active_;  ///< the worlds in which something changed in this frame
  bool is_first_ = true;               ///< no frame was run: there are no answers to keep
  std::vector<PairRun> runs_;          ///< by world
  std::vector<PairRun> began_;         ///< by active world
  std::vector<PairRun> ended_;
};

}  // namespace broadmark
