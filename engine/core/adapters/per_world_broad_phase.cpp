// Several worlds at the same location, for algorithms that would mix their bodies in one structure.
//
// Each world has an independent instance of the algorithm: its bodies have contiguous indices, in
// the order of their ids, and its collision filter has only layers and tags. A frame costs
// O(changed bodies), the work of the instances with changes, and O(their pairs) to map pairs back
// to body ids. Unchanged worlds retain their answers.
//
// An instance runs all phases while its world is in the caches: all of them count as phase 4, and
// the copying of boxes as phase 1. Running each phase over all worlds took up to 1.3 times as long
// with many small worlds.

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <span>
#include <utility>

#include "adapters/mapped_pairs.h"
#include "adapters/remapping_debug_draw.h"
#include "broadmark/adapters.h"

namespace broadmark {
namespace {

/// The scene as one world's instance sees it.
SceneInfo sceneOf(const SceneInfo& all, std::span<const std::uint32_t> bodies) {
  std::vector<BodyGroups> groups;
  for (const std::uint32_t body : bodies) {
    groups.push_back(all.filter.groupsOf(body));
    groups.back().world = 0;
  }

  SceneInfo world = all;
  world.objects = static_cast<std::uint32_t>(bodies.size());
  world.filter = {groups, all.filter.matrix(), all.filter_changes};
  return world;
}

/// Sums of the instances' counters, by name, in order of first appearance.
class Sums {
 public:
  void add(std::string_view name, std::uint64_t count) {
    const auto entry = std::ranges::find(sums_, name, &Sum::first);
    if (entry == sums_.end()) {
      sums_.emplace_back(name, count);
    } else {
      entry->second += count;
    }
  }

  CounterVisitor adder() {
    return [this](std::string_view name, std::uint64_t count) { add(name, count); };
  }

  void report(const CounterVisitor& visit) const {
    for (const auto& [name, sum] : sums_) visit(name, sum);
  }

 private:
  using Sum = std::pair<std::string, std::uint64_t>;
  std::vector<Sum> sums_;
};

/// Wraps the instances. Each worker of a team gets a fixed share of the worlds; if the worlds
/// are fewer than the workers, they run sequentially, each on the whole team.
class PerWorldBroadPhase final : public BroadPhase {
 public:
  /// Creates the instances. With `concurrent`, instances may be called at the same time.
  PerWorldBroadPhase(const SceneInfo& scene, const InstanceMaker& make, bool concurrent)
      : concurrent_(concurrent) {
    std::map<std::uint32_t, std::vector<std::uint32_t>> bodies_of;
    for (std::uint32_t body = 0; body < scene.objects; ++body) {
      bodies_of[scene.filter.worlds()[body]].push_back(body);
    }
    locations_.assign(scene.objects, {kNoBody, 0});
    for (auto& [number, bodies] : bodies_of) {
      if (bodies.size() < 2) continue;  // no pairs are possible
      for (std::uint32_t i = 0; i < bodies.size(); ++i) {
        locations_[bodies[i]] = {static_cast<std::uint32_t>(worlds_.size()), i};
      }
      World& world = worlds_.emplace_back();
      world.number = number;
      world.bodies = std::move(bodies);
      world.scene = sceneOf(scene, world.bodies);
      world.instance = make(world.scene);
    }
  }

  [[nodiscard]] float margin() const override {
    return worlds_.empty() ? 0 : worlds_.front().instance->margin();
  }

  void initialize(const SceneInfo&, const Frame& first, ExecutionContext& execution) override {
    assignWorlds(execution);
    active_.resize(worlds_.size());
    std::iota(active_.begin(), active_.end(), 0U);
    runs_.resize(worlds_.size());
    began_.reserve(worlds_.size());
    ended_.reserve(worlds_.size());
    forEachActive([&](World& world) {
      world.boxes.reserve(world.bodies.size());
      for (const std::uint32_t body : world.bodies) world.boxes.push_back(first.boxes[body]);
      world.changed.reserve(world.bodies.size());
      world.instance->initialize(world.scene, world.frame(), *world.execution);
      if (reports_events_) world.storeEvents();
    });
    if (reports_events_) gatherEvents();
  }

  void updateObjects(const Frame& frame) override {
    const bool is_first = std::exchange(is_first_, false);
    if (!is_first) active_.clear();
    for (const std::uint32_t body : *frame.changed) {
      const BodyLocation location = locations_[body];
      if (location.world == kNoBody) continue;
      World& world = worlds_[location.world];
      if (world.changed.empty() && !is_first) active_.push_back(location.world);
      world.changed.push_back(location.body);
      world.boxes[location.body] = frame.boxes[body];
    }
    for (const std::uint32_t body : frame.filter_changed) {
      const BodyLocation location = locations_[body];
      if (location.world == kNoBody) continue;
      World& world = worlds_[location.world];
      if (world.changed.empty() && world.filter_changed.empty() && !is_first) {
        active_.push_back(location.world);
      }
      if (world.filter_changed.empty()) world.scene.filter = frame.filter->of(world.bodies);
      world.filter_changed.push_back(location.body);
    }
  }

  void searchOverlaps() override {
    forEachActive([this](World& world) {
      ++world.index;
      world.instance->updateObjects(world.frame());
      world.changed.clear();
      world.filter_changed.clear();
      world.instance->cleanCache();
      world.instance->updateStructures();
      world.instance->searchOverlaps();
      if (reports_events_) {
        world.storeEvents();
      } else {
        world.mapToBodies(world.instance->overlaps(), world.pairs);
      }
    });
    if (reports_events_) {
      gatherEvents();
    } else {
      for (const std::uint32_t world : active_) runs_[world] = worlds_[world].pairs;
    }
  }
  [[nodiscard]] PairRuns overlaps() const override { return runs_; }
  void reportEvents() override {
    reports_events_ = true;
    for (World& world : worlds_) world.instance->reportEvents();
  }
  [[nodiscard]] PairEvents events() const override { return {began_, ended_}; }
  [[nodiscard]] TransferTimes transfers() const override {
    TransferTimes sum;
    for (const std::uint32_t world : active_) {
      const TransferTimes times = worlds_[world].instance->transfers();
      sum.upload_ns += times.upload_ns;
      sum.download_ns += times.download_ns;
    }
    return sum;
  }

  void drawStructure(DebugDraw& draw) const override {
    for (const World& world : worlds_) {
      RemappingDebugDraw remapped(draw, world.bodies);
      world.instance->drawStructure(remapped);
    }
  }

  /// Sums over the worlds with changes.
  void visitCounters(const CounterVisitor& visit) const override {
    Sums sums;
    sums.add("worlds with changes", active_.size());
    for (const std::uint32_t world : active_) {
      worlds_[world].instance->visitCounters(sums.adder());
    }
    sums.report(visit);
  }

  /// Sums over all worlds.
  void visitSetup(const CounterVisitor& visit) const override {
    Sums sums;
    for (const World& world : worlds_) world.instance->visitSetup(sums.adder());
    sums.report(visit);
  }

  [[nodiscard]] std::string validate() const override {
    for (const World& world : worlds_) {
      const std::string violation = world.instance->validate();
      if (!violation.empty()) return fmt::format("world {}: {}", world.number, violation);
    }
    return {};
  }

 private:
  /// One world, on cache lines of its own: neighbouring worlds may belong to other workers.
  struct alignas(64) World {
    std::uint32_t number = 0;           ///< its number in the collision filter
    std::vector<std::uint32_t> bodies;  ///< their ids, ascending
    SceneInfo scene;
    std::unique_ptr<BroadPhase> instance;
    ExecutionContext* execution = nullptr;
    std::uint32_t index = 0;  ///< the instance's last frame; frames without changes do not count
    std::vector<Aabb> boxes;
    std::vector<std::uint32_t> changed;         ///< indices into `bodies`, ascending
    std::vector<std::uint32_t> filter_changed;  ///< indices into `bodies`, ascending
    std::vector<Pair> pairs;                    ///< by body id
    std::vector<Pair> began;
    std::vector<Pair> ended;

    [[nodiscard]] Frame frame() const {
      return {index, boxes, changed, scene.filter_changes ? &scene.filter : nullptr,
              filter_changed};
    }
    void mapToBodies(PairRuns found, std::vector<Pair>& into) const {
      into.resize(pairCount(found));
      auto next = into.begin();
      for (const PairRun chunk : found) {
        for (const Pair pair : chunk) {
          const bool exist = std::max(pair.a, pair.b) < bodies.size();
          *next++ = exist ? Pair{bodies[pair.a], bodies[pair.b]}
                          : Pair{kNoBody, kNoBody};  // keeps an invalid pair invalid
        }
      }
    }
    void storeEvents() {
      const PairEvents events = instance->events();
      mapToBodies(events.began, began);
      mapToBodies(events.ended, ended);
    }
  };
  /// A body's world and its index there.
  struct BodyLocation {
    std::uint32_t world = 0;
    std::uint32_t body = 0;
  };

  /// Calls call(world) for each world with changes, on the worker that owns it.
  template <class Call>
  void forEachActive(Call call) {
    if (team_ == nullptr) {
      for (const std::uint32_t world : active_) call(worlds_[world]);
      return;
    }
    team_->run([&](int worker) {
      const ExecutionContext* const own = executions_[static_cast<std::size_t>(worker)].get();
      for (const std::uint32_t world : active_) {
        if (worlds_[world].execution == own) call(worlds_[world]);
      }
    });
  }

  /// Assigns the worlds to workers, permanently: a worker finds its worlds in its caches.
  void assignWorlds(ExecutionContext& execution) {
    const auto workers = static_cast<std::size_t>(execution.threads());
    if (concurrent_ && workers > 1 && worlds_.size() >= workers) {
      team_ = &execution.team();
      for (std::size_t worker = 0; worker < workers; ++worker) {
        executions_.push_back(
            std::make_unique<ExecutionContext>(1, execution.isa(), execution.device()));
      }
    }
    for (std::size_t i = 0; i < worlds_.size(); ++i) {
      worlds_[i].execution = team_ == nullptr ? &execution : executions_[i % workers].get();
    }
  }

  void gatherEvents() {
    began_.clear();
    ended_.clear();
    for (const std::uint32_t world : active_) {
      began_.emplace_back(worlds_[world].began);
      ended_.emplace_back(worlds_[world].ended);
    }
  }

  ThreadTeam* team_ = nullptr;  ///< null unless workers share the worlds
  std::vector<std::unique_ptr<ExecutionContext>> executions_;  ///< one per worker if team_ is set
  std::vector<World> worlds_;            ///< worlds with at least two bodies, by number
  std::vector<BodyLocation> locations_;  ///< by body
  bool concurrent_;
  bool reports_events_ = false;
  std::vector<std::uint32_t> active_;  ///< the worlds with changes in this frame
  bool is_first_ = true;               ///< no frame has run yet
  std::vector<PairRun> runs_;          ///< by world
  std::vector<PairRun> began_;         ///< by active world
  std::vector<PairRun> ended_;
};

}  // namespace

std::size_t worldCount(const SceneInfo& scene) {
  const std::span<const std::uint32_t> worlds = scene.filter.worlds();
  if (worlds.empty()) return 1;
  return std::set<std::uint32_t>(worlds.begin(), worlds.end()).size();
}

std::unique_ptr<BroadPhase> perWorld(const SceneInfo& scene, const InstanceMaker& make,
                                     bool concurrent) {
  return std::make_unique<PerWorldBroadPhase>(scene, make, concurrent);
}

}  // namespace broadmark
