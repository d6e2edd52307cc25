// The four broad phases of PhysX for processors, alone:
//  sap   sweep and prune on three axes, kept sorted from frame to frame
//  mbp   "multi box pruning": regions of space, in each a sweep over boxes that stay sorted
//  abp   "automatic box pruning": the same with regions of its own choice
//  pabp  the same on several threads
// O(m log n + k) and more where many move; O(n + k) space.
//
// Used by the stand-alone interface (PxBroadPhase.h): told what was created, updated and removed,
// they tell which pairs came and went. Bodies of layers that never meet each other are put into the
// group of static bodies, the others each into one of its own, as advised there. MBP gets the four
// by four regions that its documentation begins with, and up to sixteen by sixteen for many bodies,
// as a region holds 65,534 of them (region_loads.h); the outermost ones have no end, as bodies
// outside of all regions would not collide. A team of several gets a dispatcher of as many threads.
//
// Bounds become integers that lose the last bit or two, so PhysX's pairs are candidates: in each
// frame the boxes decide which of those that moved overlap, and the answer is exact. A pair begins
// when PhysX says so, or when a candidate meets within these bits; it ends likewise.
//
// Library: PhysX 5, NVIDIA.

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "broadmark/non_colliding_layers.h"
#include "broadmark/pair_set.h"
#include "broadmark/plugin.h"
#include "physx/library.h"
#include "physx/region_loads.h"

namespace broadmark::physx_broad_phases {
namespace {

using physx::PxBroadPhaseType;
using physx::PxU32;

/// MBP's regions on each of two axes: PhysX allows 256 in all.
int regionsFor(std::size_t bodies) {
  constexpr std::size_t kUsual = 16'384;  // bodies in one, if they are spread evenly
  int regions = 4;
  while (regions < 16 && bodies > kUsual * static_cast<std::size_t>(regions * regions))
    regions *= 2;
  return regions;
}

/// Those axes: not the one that points upwards.
constexpr std::array kDivided = {2, 0};

physx::PxBounds3 boundsOf(const Aabb& box) {
  return {{box.min[0], box.min[1], box.min[2]}, {box.max[0], box.max[1], box.max[2]}};
}

/// PhysX's own threads, and what tells that they are done with a frame.
class Workers {
 public:
  explicit Workers(int threads)
      : dispatcher_(physx::PxDefaultCpuDispatcherCreate(static_cast<PxU32>(threads))),
        tasks_(physx::PxTaskManager::createTaskManager(PxGetFoundation().getErrorCallback(),
                                                       dispatcher_.get())) {}

  /// Calls work(the task to go on with), and waits for that.
  template <class Work>
  void run(Work work) {
    Done done;
    done.setContinuation(*tasks_, nullptr);
    work(&done);
    done.removeReference();
    done.finished.wait();
  }

 private:
  struct Done final : physx::PxLightCpuTask {
    physx::PxSync finished;

    void run() override {}
    void release() override {
      PxLightCpuTask::release();
      finished.set();
    }
    const char* getName() const override { return "done"; }
  };

  std::unique_ptr<physx::PxDefaultCpuDispatcher, ReleasePhysX> dispatcher_;
  std::unique_ptr<physx::PxTaskManager, ReleasePhysX> tasks_;
};

class PhysX final : public BroadPhase {
 public:
  explicit PhysX(PxBroadPhaseType::Enum type) {
    physXFoundation();
    const physx::PxBroadPhaseDesc description(type);
    broad_phase_.reset(PxCreateBroadPhase(description));
    if (!broad_phase_) throw UnsupportedError("PhysX: creates no broad phase");
  }

  void initialize(const SceneInfo& scene, const Frame& first,
                  ExecutionContext& execution) override {
    filter_ = scene.filter;
    team_ = &execution.team();
    if (execution.threads() > 1) workers_.emplace(execution.threads());
    const std::vector<std::uint32_t> bodies = first.presentBodies();
    const NonCollidingLayers layers(filter_, bodies);
    const std::size_t room = first.boxes.size() + 1;  // PhysX reads a bit further
    bounds_.assign(room, physx::PxBounds3(physx::PxVec3(0), physx::PxVec3(0)));
    distances_.assign(room, 0);
    for (std::uint32_t body = 0; body < first.boxes.size(); ++body) {
      groups_.push_back(layers.contains(body) ? physx::PxGetBroadPhaseStaticFilterGroup()
                                              : physx::PxGetBroadPhaseDynamicFilterGroup(body));
    }
    groups_.push_back(0);
    is_there_.assign(room, 0);
    has_moved_.assign(room, 0);
    parted_ = std::vector<PairBuffer>(static_cast<std::size_t>(team_->size()));
    if (physx::PxBroadPhaseRegions* regions = broad_phase_->getRegions()) {
      loads_.emplace(scene.world, kDivided, regionsFor(first.boxes.size()), first.boxes.size());
      addRegions(*regions);
    }
    for (const std::uint32_t body : bodies) takeOver(body, first.boxes[body]);
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
    for (const std::uint32_t body : *frame.changed) takeOver(body, frame.boxes[body]);
  }

  void cleanCache() override {
    began_.clear();
    ended_.clear();
  }

  void updateStructures() override {
    if (created_.empty() && updated_.empty() && removed_.empty()) return;
    const auto count = [](const auto& bodies) { return static_cast<PxU32>(bodies.size()); };
    const physx::PxBroadPhaseUpdateData data(
        created_.data(), count(created_), updated_.data(), count(updated_), removed_.data(),
        count(removed_), bounds_.data(), groups_.data(), distances_.data(), count(bounds_) - 1);
    if (workers_) {
      workers_->run([&](physx::PxBaseTask* next) { broad_phase_->update(data, next); });
    } else {
      broad_phase_->update(data);
    }
    physx::PxBroadPhaseResults results;
    broad_phase_->fetchResults(results);
    PhysXErrors::instance().check();
    if (loads_) loads_->settle();
    if (!removed_.empty()) dropRemoved();
    for (PxU32 i = 0; i < results.mNbDeletedPairs; ++i) {
      const Pair pair = pairOf(results.mDeletedPairs[i]);
      if (areThere(pair) && isWanted(pair)) drop(pair);
    }
    for (PxU32 i = 0; i < results.mNbCreatedPairs; ++i) {
      const Pair pair = pairOf(results.mCreatedPairs[i]);
      if (isWanted(pair)) apart_.insert(PairRun(&pair, 1));
    }
  }

  void searchOverlaps() override {
    if (!created_.empty() || !updated_.empty()) {
      findParted();
      findMet();
    }
    runs_ = {overlapping_.run(), began_.run(), ended_.run()};
  }

  [[nodiscard]] PairRuns overlaps() const override { return {&runs_.overlapping, 1}; }
  [[nodiscard]] PairEvents events() const override {
    return {{&runs_.began, 1}, {&runs_.ended, 1}};
  }

  void visitCounters(const CounterVisitor& visit) const override {
    visit("moves", updated_.size());
    visit("pairs begun", began_.size());
    visit("pairs ended", ended_.size());
    visit("candidates", overlapping_.run().size() + apart_.run().size());
  }

  [[nodiscard]] std::string validate() const override {
    const auto overlapping = [this](Pair pair) { return areThere(pair) && overlap(pair); };
    const auto apart = [this](Pair pair) { return areThere(pair) && !overlap(pair); };
    if (!std::ranges::all_of(overlapping_.run(), overlapping)) return "a pair is apart";
    if (!std::ranges::all_of(apart_.run(), apart)) return "a candidate overlaps";
    return {};
  }

 private:
  static Pair pairOf(const physx::PxBroadPhasePair& pair) {
    return orderedPair(pair.mID0, pair.mID1);
  }

  [[nodiscard]] bool areThere(Pair pair) const {
    return (is_there_[pair.a] & is_there_[pair.b]) != 0;
  }

  [[nodiscard]] bool isWanted(Pair pair) const { return filter_.wanted(pair.a, pair.b); }
  [[nodiscard]] bool hasMoved(Pair pair) const {
    return (has_moved_[pair.a] | has_moved_[pair.b]) != 0;
  }
  [[nodiscard]] bool overlap(Pair pair) const {
    return bounds_[pair.a].intersects(bounds_[pair.b]);
  }

  void takeOver(std::uint32_t body, const Aabb& box) {
    const bool is_present = !isEmpty(box);
    const bool was_there = is_there_[body] != 0;
    is_there_[body] = has_moved_[body] = is_present ? 1 : 0;
    if (is_present) bounds_[body] = boundsOf(box);
    if (is_present) (was_there ? updated_ : created_).push_back(body);
    if (!is_present && was_there) removed_.push_back(body);
    if (!loads_) return;
    if (is_present) loads_->move(body, bounds_[body]);
    if (!is_present && was_there) loads_->remove(body);
  }

  /// No longer a candidate.
  void drop(Pair pair) {
    if (overlapping_.contains(pair)) {
      overlapping_.erase(PairRun(&pair, 1));
      ended_.add(pair.a, pair.b);
    } else {
      apart_.erase(PairRun(&pair, 1));
    }
  }

  /// PhysX does not tell of all pairs of removed bodies that they are gone.
  void dropRemoved() {
    gone_.clear();
    for (const PairRun candidates : {overlapping_.run(), apart_.run()}) {
      for (const Pair pair : candidates) {
        if (!areThere(pair)) gone_.push_back(pair);
      }
    }
    for (const Pair pair : gone_) drop(pair);
  }

  /// Pairs that no longer overlap, and are candidates yet.
  void findParted() {
    const PairRun pairs = overlapping_.run();
    team_->run(pairs.size(), [&](int worker, Range part) {
      PairBuffer& parted = parted_[static_cast<std::size_t>(worker)];
      parted.clear();
      for (const Pair pair : pairs.subspan(part.begin, part.size())) {
        if (hasMoved(pair) && !overlap(pair)) parted.add(pair.a, pair.b);
      }
    });
    for (const PairBuffer& parted : parted_) {
      for (const Pair pair : parted.run()) {
        drop(pair);
        apart_.insert(PairRun(&pair, 1));
      }
    }
  }

  /// Candidates that overlap now.
  void findMet() {
    met_.clear();
    for (const Pair pair : apart_.run()) {
      if (hasMoved(pair) && overlap(pair)) met_.push_back(pair);
    }
    for (const Pair pair : met_) {
      apart_.erase(PairRun(&pair, 1));
      overlapping_.insert(PairRun(&pair, 1));
      began_.add(pair.a, pair.b);
    }
  }

  void addRegions(physx::PxBroadPhaseRegions& regions) const {
    for (int i = 0; i < loads_->count(); ++i) {
      for (int j = 0; j < loads_->count(); ++j) {
        physx::PxBounds3 bounds(physx::PxVec3(-PX_MAX_BOUNDS_EXTENTS),
                                physx::PxVec3(PX_MAX_BOUNDS_EXTENTS));
        const std::array<int, 2> place = {i, j};
        for (std::size_t side = 0; side < 2; ++side) {
          bounds.minimum[static_cast<unsigned>(kDivided[side])] = loads_->low(side, place[side]);
          bounds.maximum[static_cast<unsigned>(kDivided[side])] = loads_->high(side, place[side]);
        }
        regions.addRegion({bounds, nullptr}, false, bounds_.data(), distances_.data());
      }
    }
  }

  CollisionFilter filter_;
  ThreadTeam* team_ = nullptr;
  std::unique_ptr<physx::PxBroadPhase, ReleasePhysX> broad_phase_;
  std::optional<Workers> workers_;
  std::optional<RegionLoads> loads_;  ///< of MBP
  // By body, with room for one more.
  std::vector<physx::PxBounds3> bounds_;
  std::vector<physx::PxBpFilterGroup> groups_;
  std::vector<float> distances_;
  std::vector<std::uint8_t> is_there_;
  std::vector<std::uint8_t> has_moved_;  ///< or come, in this frame
  // PhysX's pairs, as far as they are wanted.
  PairSet overlapping_;
  PairSet apart_;  ///< no more than the lost bits
  // In this frame.
  std::vector<PxU32> created_;
  std::vector<PxU32> updated_;
  std::vector<PxU32> removed_;
  std::vector<Pair> gone_;
  std::vector<Pair> met_;
  std::vector<PairBuffer> parted_;  ///< by worker
  PairBuffer began_;
  PairBuffer ended_;
  struct {
    PairRun overlapping, began, ended;
  } runs_;
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
