// The four CPU broad phases of PhysX:
//  sap   incremental sweep and prune on three axes
//  mbp   "multi box pruning": incremental sweep and prune in given regions
//  abp   "automatic box pruning": sweep and prune in regions chosen by PhysX
//  pabp  abp on several threads
// O(m log n + k) time, more if many bodies move; O(n + k) space.
//
// The stand-alone interface (PxBroadPhase.h) takes created, updated and removed bodies and returns
// created and deleted pairs. As recommended there, bodies of non-colliding layers are in the group
// of static bodies and every other body is in its own group. MBP has four by four regions, as in
// its documentation, and up to sixteen by sixteen for many bodies, because a region holds at most
// 65,534 bodies (region_loads.h). The outer regions are unbounded, because bodies outside of all
// regions would not collide. A thread team has a dispatcher with the same number of threads.
//
// PhysX rounds bounds to integers, so its pairs are candidates (candidate_pairs.h).
//
// Library: PhysX 5, NVIDIA.

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "broadmark/non_colliding_layers.h"
#include "broadmark/plugin.h"
#include "candidate_pairs.h"
#include "physx/library.h"
#include "physx/region_loads.h"

namespace broadmark::physx_broad_phases {
namespace {

using physx::PxBroadPhaseType;
using physx::PxU32;

/// The number of MBP's regions per axis, for two axes. PhysX allows 256 regions in total.
int regionsFor(std::size_t bodies) {
  constexpr std::size_t kTargetLoad = 16'384;  // bodies per region, if spread evenly
  int regions = 4;
  while (regions < 16 && bodies > kTargetLoad * static_cast<std::size_t>(regions * regions))
    regions *= 2;
  return regions;
}

/// The horizontal axes, along which MBP's regions divide the world.
constexpr std::array kDivided = {2, 0};

physx::PxBounds3 boundsOf(const Aabb& box) {
  return {{box.min[0], box.min[1], box.min[2]}, {box.max[0], box.max[1], box.max[2]}};
}

/// PhysX's threads, and the task manager that waits for them.
class PhysXThreads {
 public:
  explicit PhysXThreads(int threads)
      : dispatcher_(physx::PxDefaultCpuDispatcherCreate(static_cast<PxU32>(threads))),
        tasks_(physx::PxTaskManager::createTaskManager(PxGetFoundation().getErrorCallback(),
                                                       dispatcher_.get())) {}

  /// Calls work(continuation task) and waits for the task to complete.
  template <class Work>
  void run(Work work) {
    CompletionTask completion;
    completion.setContinuation(*tasks_, nullptr);
    work(&completion);
    completion.removeReference();
    completion.finished.wait();
  }

 private:
  struct CompletionTask final : physx::PxLightCpuTask {
    physx::PxSync finished;

    void run() override {}
    void release() override {
      PxLightCpuTask::release();
      finished.set();
    }
    const char* getName() const override { return "completion"; }
  };

  PhysXPtr<physx::PxDefaultCpuDispatcher> dispatcher_;
  PhysXPtr<physx::PxTaskManager> tasks_;
};

class PhysX final : public BroadPhase {
 public:
  explicit PhysX(PxBroadPhaseType::Enum type) {
    physXFoundation();
    const physx::PxBroadPhaseDesc description(type);
    broad_phase_.reset(PxCreateBroadPhase(description));
    if (!broad_phase_) throw UnsupportedError("PhysX: cannot create a broad phase");
  }

  void initialize(const SceneInfo& scene, const Frame& first,
                  ExecutionContext& execution) override {
    filter_ = scene.filter;
    team_ = &execution.team();
    if (execution.threads() > 1) threads_.emplace(execution.threads());
    const std::vector<std::uint32_t> bodies = first.presentBodies();
    static_layers_ = NonCollidingLayers(filter_, bodies);
    const std::size_t count = first.boxes.size() + 1;  // PhysX reads past the last body
    bounds_.assign(count, physx::PxBounds3(physx::PxVec3(0), physx::PxVec3(0)));
    distances_.assign(count, 0);
    for (std::uint32_t body = 0; body < first.boxes.size(); ++body) {
      groups_.push_back(groupOf(body));
    }
    groups_.push_back(0);
    is_present_.assign(count, 0);
    has_moved_.assign(count, 0);
    if (physx::PxBroadPhaseRegions* regions = broad_phase_->getRegions()) {
      loads_.emplace(scene.world, kDivided, regionsFor(first.boxes.size()), first.boxes.size());
      addRegions(*regions);
    }
    for (const std::uint32_t body : bodies) applyBox(body, first.boxes[body]);
    updateStructures();
    searchOverlaps();
  }

  void updateObjects(const Frame& frame) override {
    for (const std::vector<PxU32>* bodies : {&created_, &updated_}) {
      for (const PxU32 body : *bodies) has_moved_[body] = 0;
    }
    created_.clear();
    updated_.clear();
    removed_.clear();
    for (const std::uint32_t body : *frame.changed) applyBox(body, frame.boxes[body]);
  }

  void cleanCache() override { pairs_.clearEvents(); }

  void updateStructures() override {
    if (created_.empty() && updated_.empty() && removed_.empty()) return;
    const auto count = [](const auto& bodies) { return static_cast<PxU32>(bodies.size()); };
    const physx::PxBroadPhaseUpdateData data(
        created_.data(), count(created_), updated_.data(), count(updated_), removed_.data(),
        count(removed_), bounds_.data(), groups_.data(), distances_.data(), count(bounds_) - 1);
    if (threads_) {
      threads_->run([&](physx::PxBaseTask* next) { broad_phase_->update(data, next); });
    } else {
      broad_phase_->update(data);
    }
    physx::PxBroadPhaseResults results;
    broad_phase_->fetchResults(results);
    PhysXErrors::instance().check();
    if (loads_) loads_->endFrame();
    // PhysX does not report all deleted pairs of removed bodies.
    if (!removed_.empty()) pairs_.dropIf([this](Pair pair) { return !arePresent(pair); });
    for (PxU32 i = 0; i < results.mNbDeletedPairs; ++i) {
      const Pair pair = pairOf(results.mDeletedPairs[i]);
      if (arePresent(pair) && isWanted(pair)) pairs_.drop(pair);
    }
    for (PxU32 i = 0; i < results.mNbCreatedPairs; ++i) {
      const Pair pair = pairOf(results.mCreatedPairs[i]);
      if (isWanted(pair)) pairs_.insert(PairRun(&pair, 1));
    }
  }

  void searchOverlaps() override {
    if (!created_.empty() || !updated_.empty()) {
      pairs_.update(
          *team_, [this](Pair pair) { return hasMoved(pair); },
          [this](Pair pair) { return overlap(pair); });
    }
    pairs_.endFrame();
  }

  [[nodiscard]] PairRuns overlaps() const override { return pairs_.overlaps(); }
  [[nodiscard]] PairEvents events() const override { return pairs_.events(); }

  void visitCounters(const CounterVisitor& visit) const override {
    visit("moves", updated_.size());
    pairs_.visitCounters(visit);
  }

  [[nodiscard]] std::string validate() const override {
    return pairs_.validate([this](Pair pair) { return arePresent(pair); },
                           [this](Pair pair) { return overlap(pair); });
  }

 private:
  static Pair pairOf(const physx::PxBroadPhasePair& pair) {
    return orderedPair(pair.mID0, pair.mID1);
  }

  [[nodiscard]] bool arePresent(Pair pair) const {
    return (is_present_[pair.a] & is_present_[pair.b]) != 0;
  }

  [[nodiscard]] physx::PxBpFilterGroup groupOf(std::uint32_t body) const {
    return static_layers_.contains(filter_.layerOf(body))
               ? physx::PxGetBroadPhaseStaticFilterGroup()
               : physx::PxGetBroadPhaseDynamicFilterGroup(body);
  }
  [[nodiscard]] bool isWanted(Pair pair) const { return filter_.wanted(pair.a, pair.b); }
  [[nodiscard]] bool hasMoved(Pair pair) const {
    return (has_moved_[pair.a] | has_moved_[pair.b]) != 0;
  }
  [[nodiscard]] bool overlap(Pair pair) const {
    return bounds_[pair.a].intersects(bounds_[pair.b]);
  }

  void applyBox(std::uint32_t body, const Aabb& box) {
    const bool is_present = !isEmpty(box);
    const bool was_present = is_present_[body] != 0;
    is_present_[body] = has_moved_[body] = is_present ? 1 : 0;
    if (is_present) bounds_[body] = boundsOf(box);
    if (is_present && !was_present) groups_[body] = groupOf(body);  // a LiveFilter may have changed
    if (is_present) (was_present ? updated_ : created_).push_back(body);
    if (!is_present && was_present) removed_.push_back(body);
    if (!loads_) return;
    if (is_present) loads_->move(body, bounds_[body]);
    if (!is_present && was_present) loads_->remove(body);
  }

  void addRegions(physx::PxBroadPhaseRegions& regions) const {
    for (int i = 0; i < loads_->count(); ++i) {
      for (int j = 0; j < loads_->count(); ++j) {
        physx::PxBounds3 bounds(physx::PxVec3(-PX_MAX_BOUNDS_EXTENTS),
                                physx::PxVec3(PX_MAX_BOUNDS_EXTENTS));
        const std::array<int, 2> index = {i, j};
        for (std::size_t side = 0; side < 2; ++side) {
          bounds.minimum[static_cast<unsigned>(kDivided[side])] = loads_->low(side, index[side]);
          bounds.maximum[static_cast<unsigned>(kDivided[side])] = loads_->high(side, index[side]);
        }
        regions.addRegion({bounds, nullptr}, false, bounds_.data(), distances_.data());
      }
    }
  }

  CollisionFilter filter_;
  NonCollidingLayers static_layers_;
  ThreadTeam* team_ = nullptr;
  PhysXPtr<physx::PxBroadPhase> broad_phase_;
  std::optional<PhysXThreads> threads_;
  std::optional<RegionLoads> loads_;  ///< only for MBP
  // By body, with an extra entry.
  std::vector<physx::PxBounds3> bounds_;
  std::vector<physx::PxBpFilterGroup> groups_;
  std::vector<float> distances_;
  std::vector<std::uint8_t> is_present_;
  std::vector<std::uint8_t> has_moved_;  ///< moved or appeared in this frame
  CandidatePairs pairs_;                 ///< that pass the filter
  // Of the current frame.
  std::vector<PxU32> created_;
  std::vector<PxU32> updated_;
  std::vector<PxU32> removed_;
};

}  // namespace

std::vector<Algorithm> variants() {
  const auto variant = [](PxBroadPhaseType::Enum type, const char* id, const char* principle,
                          const char* summary) {
    return Algorithm{.id = id,
                     .family = "PhysX",
                     .summary = summary,
                     .traits = {.parallel = type == PxBroadPhaseType::ePABP,
                                .incremental = true,
                                .events = true,
                                .library_allocates = true,
                                .changing_worlds = ChangingWorlds::native,
                                .instance_per_world = true,
                                .max_objects = std::size_t{1} << 29},
                     .description = {.principle = principle,
                                     .optimisations = "incremental, integer bounds",
                                     .time = "O(m log n + k), m bodies that move",
                                     .space = "O(n + k)",
                                     .source = "PhysX 5, PxBroadPhase"},
                     .create = [type] { return std::make_unique<PhysX>(type); }};
  };
  return {variant(PxBroadPhaseType::eSAP, "physx-sap", "sorting", "PhysX's sweep and prune"),
          variant(PxBroadPhaseType::eMBP, "physx-mbp", "grid, sorting",
                  "PhysX's pruning in given regions"),
          variant(PxBroadPhaseType::eABP, "physx-abp", "grid, sorting",
                  "PhysX's pruning in regions of its own choice"),
          variant(PxBroadPhaseType::ePABP, "physx-pabp", "grid, sorting",
                  "PhysX's pruning in regions of its own choice, on several threads")};
}

}  // namespace broadmark::physx_broad_phases

BROADMARK_PLUGIN(broadmark::physx_broad_phases::variants);
