// An instance for each world, and the way from its numbers to the scene's.

#include "adapters/worlds_apart.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <span>
#include <utility>

#include "adapters/renamed_bodies.h"
#include "broadmark/adapters.h"

namespace broadmark {
namespace {

constexpr std::uint32_t kNobody = std::numeric_limits<std::uint32_t>::max();

/// What one world's instance gets to know of the scene.
SceneInfo sceneOf(const SceneInfo& all, std::span<const std::uint32_t> bodies) {
  std::vector<BodyGroups> groups;
  for (const std::uint32_t body : bodies) {
    groups.push_back(all.filter.groupsOf(body));
    groups.back().world = 0;
  }
  SceneInfo one = all;
  one.objects = static_cast<std::uint32_t>(bodies.size());
  one.filter = {groups, all.filter.matrix()};
  return one;
}

/// Sums of what several instances count, by name, in the order in which the names came.
class Sums {
 public:
  void add(std::string_view name, std::uint64_t count) {
    const auto known = std::ranges::find(sums_, name, &Sum::first);
    if (known == sums_.end()) {
      sums_.emplace_back(name, count);
    } else {
      known->second += count;
    }
  }
  CounterVisitor adder() {
    return [this](std::string_view name, std::uint64_t count) { add(name, count); };
  }
  void show(const CounterVisitor& visit) const {
    for (const auto& [name, sum] : sums_) visit(name, sum);
  }

 private:
  using Sum = std::pair<std::string, std::uint64_t>;
  std::vector<Sum> sums_;
};

}  // namespace

std::size_t worldCount(const SceneInfo& scene) {
  const std::span<const std::uint32_t> worlds = scene.filter.worlds();
  if (worlds.empty()) return 1;
  return std::set<std::uint32_t>(worlds.begin(), worlds.end()).size();
}

std::unique_ptr<BroadPhase> perWorld(const SceneInfo& scene, const WorldsApart::Maker& make,
                                     bool concurrent) {
  return std::make_unique<WorldsApart>(scene, make, concurrent);
}

WorldsApart::WorldsApart(const SceneInfo& scene, const Maker& make, bool concurrent)
    : concurrent_(concurrent) {
  std::map<std::uint32_t, std::vector<std::uint32_t>> bodies_of;
  for (std::uint32_t body = 0; body < scene.objects; ++body) {
    bodies_of[scene.filter.worlds()[body]].push_back(body);
  }
  places_.assign(scene.objects, {kNobody, 0});
  for (auto& [number, bodies] : bodies_of) {
    if (bodies.size() < 2) continue;  // there are no pairs
    for (std::uint32_t i = 0; i < bodies.size(); ++i) {
      places_[bodies[i]] = {static_cast<std::uint32_t>(worlds_.size()), i};
    }
    World& world = worlds_.emplace_back();
    world.number = number;
    world.bodies = std::move(bodies);
    world.scene = sceneOf(scene, world.bodies);
    world.instance = make(world.scene);
  }
}

float WorldsApart::margin() const {
  return worlds_.empty() ? 0 : worlds_.front().instance->margin();
}

void WorldsApart::reportEvents() {
  reports_events_ = true;
  for (World& world : worlds_) world.instance->reportEvents();
}

/// Calls call(world) for each world in which something changed, on the worker that it belongs to.
template <class Call>
void WorldsApart::forEachActive(Call call) {
  if (team_ == nullptr) {
    for (const std::uint32_t world : active_) call(worlds_[world]);
    return;
  }
  team_->run([&](int worker) {
    const Execution* const own = executions_[static_cast<std::size_t>(worker)].get();
    for (const std::uint32_t world : active_) {
      if (worlds_[world].execution == own) call(worlds_[world]);
    }
  });
}

/// Which worker runs which world, for good: it finds it in its caches.
void WorldsApart::shareOut(Execution& execution) {
  const auto workers = static_cast<std::size_t>(execution.threads());
  if (concurrent_ && workers > 1 && worlds_.size() >= workers) {
    team_ = &execution.team();
    for (std::size_t worker = 0; worker < workers; ++worker) {
      executions_.push_back(std::make_unique<Execution>(1, execution.isa(), execution.device()));
    }
  }
  for (std::size_t i = 0; i < worlds_.size(); ++i) {
    worlds_[i].execution = team_ == nullptr ? &execution : executions_[i % workers].get();
  }
}

void WorldsApart::initialize(const SceneInfo&, const Frame& first, Execution& execution) {
  shareOut(execution);
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
    if (reports_events_) world.takeEvents();
  });
  if (reports_events_) gatherEvents();
}

void WorldsApart::updateObjects(const Frame& frame) {
  const bool is_first = std::exchange(is_first_, false);
  if (!is_first) active_.clear();
  for (const std::uint32_t body : *frame.changed) {
    const Place place = places_[body];
    if (place.world == kNobody) continue;
    World& world = worlds_[place.world];
    if (world.changed.empty() && !is_first) active_.push_back(place.world);
    world.changed.push_back(place.body);
    world.boxes[place.body] = frame.boxes[body];
  }
}

void WorldsApart::searchOverlaps() {
  forEachActive([this](World& world) {
    ++world.index;
    world.instance->updateObjects(world.frame());
    world.changed.clear();
    world.instance->cleanCache();
    world.instance->updateStructures();
    world.instance->searchOverlaps();
    if (reports_events_) {
      world.takeEvents();
    } else {
      world.translate(world.instance->overlaps(), world.pairs);
    }
  });
  if (reports_events_) {
    gatherEvents();
  } else {
    for (const std::uint32_t world : active_) runs_[world] = worlds_[world].pairs;
  }
}

void WorldsApart::gatherEvents() {
  began_.clear();
  ended_.clear();
  for (const std::uint32_t world : active_) {
    began_.emplace_back(worlds_[world].began);
    ended_.emplace_back(worlds_[world].ended);
  }
}

void WorldsApart::World::takeEvents() {
  const PairEvents events = instance->events();
  translate(events.began, began);
  translate(events.ended, ended);
}

void WorldsApart::World::translate(PairRuns found, std::vector<Pair>& into) const {
  into.resize(pairCount(found));
  auto next = into.begin();
  for (const PairRun run : found) {
    for (const Pair pair : run) {
      const bool exist = std::max(pair.a, pair.b) < bodies.size();
      *next++ = exist ? Pair{bodies[pair.a], bodies[pair.b]}
                      : Pair{kNobody, kNobody};  // as wrong as it was
    }
  }
}

TransferTimes WorldsApart::transfers() const {
  TransferTimes sum;
  for (const std::uint32_t world : active_) {
    const TransferTimes times = worlds_[world].instance->transfers();
    sum.upload_ns += times.upload_ns;
    sum.download_ns += times.download_ns;
  }
  return sum;
}

void WorldsApart::drawStructure(DebugDraw& draw) const {
  for (const World& world : worlds_) {
    RenamedBodies renamed(draw, world.bodies);
    world.instance->drawStructure(renamed);
  }
}

void WorldsApart::visitCounters(const CounterVisitor& visit) const {
  Sums sums;
  sums.add("worlds with changes", active_.size());
  for (const std::uint32_t world : active_) {
    worlds_[world].instance->visitCounters(sums.adder());
  }
  sums.show(visit);
}

void WorldsApart::visitSetup(const CounterVisitor& visit) const {
  Sums sums;
  for (const World& world : worlds_) world.instance->visitSetup(sums.adder());
  sums.show(visit);
}

std::string WorldsApart::validate() const {
  for (const World& world : worlds_) {
    const std::string broken = world.instance->validate();
    if (!broken.empty()) return fmt::format("world {}: {}", world.number, broken);
  }
  return {};
}

}  // namespace broadmark
