// Worlds that change from frame to frame, and contests of algorithms in them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "benchmarks/contest.h"
#include "broadmark/collision_filter.h"
#include "broadmark/large_array.h"
#include "torture/inputs.h"

namespace broadmark::benchmarks {

/// Boxes that change a little in every frame, and the list of changed bodies.
class LivingWorld {
 public:
  LivingWorld() = default;
  LivingWorld(const LivingWorld&) = delete;
  LivingWorld& operator=(const LivingWorld&) = delete;
  virtual ~LivingWorld() = default;

  [[nodiscard]] const SceneInfo& scene() const { return scene_; }
  [[nodiscard]] Frame frame() const { return {index_, boxes_, changed_}; }
  void step() {
    ++index_;
    changed_.clear();
    change();
    std::ranges::sort(changed_);
    changed_.erase(std::unique(changed_.begin(), changed_.end()), changed_.end());
  }

 protected:
  /// Changes boxes by put().
  virtual void change() = 0;

  /// Sets the scene and its boxes; the world is a cube with edge `side`.
  void begin(std::string name, std::span<const Aabb> boxes, float side,
             CollisionFilter filter = {}) {
    scene_.name = std::move(name);
    scene_.object_type = "Cubes";
    scene_.objects = static_cast<std::uint32_t>(boxes.size());
    scene_.world = {{0, 0, 0, 0}, {side, side, side, 0}};
    scene_.all_present = std::ranges::none_of(boxes, isEmpty);
    scene_.filter = std::move(filter);
    boxes_.assign(boxes.begin(), boxes.end());
    side_ = side;
  }
  [[nodiscard]] const Aabb& box(std::uint32_t body) const { return boxes_[body]; }
  [[nodiscard]] std::uint32_t size() const { return scene_.objects; }
  void put(std::uint32_t body, const Aabb& box) {
    if (boxes_[body] == box) return;
    boxes_[body] = box;
    changed_.push_back(body);
  }

  [[nodiscard]] std::uint32_t randomBody() {
    return std::uniform_int_distribution<std::uint32_t>(0, size() - 1)(random_);
  }
  [[nodiscard]] float number(float low, float high) {
    return std::uniform_real_distribution<float>(low, high)(random_);
  }
  /// A unit cube at a random position.
  [[nodiscard]] Aabb randomCube() {
    return inputs::boxAt({number(0, side_), number(0, side_), number(0, side_)}, {1, 1, 1});
  }
  /// The unit cube after a random step of up to `max` on each axis, clamped to the world.
  [[nodiscard]] Aabb stepped(const Aabb& box, float max) {
    const auto moved = [&](std::size_t axis) {
      return std::clamp(box.min[axis] + number(-max, max), 0.0F, side_);
    };
    return inputs::boxAt({moved(0), moved(1), moved(2)}, {1, 1, 1});
  }

 private:
  SceneInfo scene_;
  LargeVector<Aabb> boxes_;
  std::vector<std::uint32_t> changed_;
  std::uint32_t index_ = 0;
  float side_ = 0;
  std::mt19937 random_{1};
};

/// Unit cubes, a tenth of the space: nearly all are static and, with `layers`, not paired with each
/// other; the last `movers` bodies move.
class StaticLevel final : public LivingWorld {
 public:
  StaticLevel(std::uint32_t still, std::uint32_t movers, bool layers = true) : movers_(movers) {
    const std::uint32_t bodies = still + movers;
    std::vector<BodyGroups> groups(bodies);
    for (std::uint32_t body = still; body < bodies; ++body) groups[body].layer = 1;
    begin("StaticLevel", inputs::uniform(bodies, 0, 1), inputs::cubeRoot(10.0 * bodies),
          layers ? CollisionFilter(groups, LayerMatrix().set(0, 1).set(1, 1)) : CollisionFilter());
  }

 private:
  void change() override {
    for (std::uint32_t i = 0; i < movers_; ++i) {
      const std::uint32_t body = size() - 1 - i;
      put(body, stepped(box(body), 0.2F));
    }
  }

  std::uint32_t movers_;
};

/// In every frame, a random selection of `movers` bodies moves; or all.
class SomeMove final : public LivingWorld {
 public:
  SomeMove(std::span<const Aabb> boxes, std::uint32_t movers) : movers_(movers) {
    begin("SomeMove", boxes, inputs::cubeRoot(10.0 * static_cast<double>(boxes.size())));
  }

 private:
  void change() override {
    for (std::uint32_t i = 0; i < movers_; ++i) {
      const std::uint32_t body = movers_ == size() ? i : randomBody();
      Aabb to = box(body);
      for (int axis = 0; axis < 3; ++axis) {
        const float step = number(-0.5F, 0.5F);
        to.min[axis] += step;
        to.max[axis] += step;
      }
      put(body, to);
    }
  }

  std::uint32_t movers_;
};

/// In every frame, some bodies vanish, and as many appear elsewhere in free slots.
class ComeAndGo final : public LivingWorld {
 public:
  ComeAndGo(std::uint32_t bodies, std::uint32_t guests) {
    std::vector<Aabb> boxes = inputs::uniform(bodies, 0, 1);
    for (std::uint32_t i = 0; i < guests; ++i) {
      free_.push_back(static_cast<std::uint32_t>(boxes.size()));
      boxes.push_back(kEmptyBox);
    }
    begin("ComeAndGo", boxes, inputs::cubeRoot(10.0 * bodies));
  }

 private:
  void change() override {
    const std::vector<std::uint32_t> arriving = free_;
    for (std::uint32_t& slot : free_) {
      do slot = randomBody();
      while (isEmpty(box(slot)));
      put(slot, kEmptyBox);
    }
    for (const std::uint32_t slot : arriving) put(slot, randomCube());
  }

  std::vector<std::uint32_t> free_;
};

/// Small worlds, all at the same position.
class ManyWorlds final : public LivingWorld {
 public:
  ManyWorlds(std::uint32_t worlds, std::uint32_t bodies_each)
      : worlds_(worlds), bodies_each_(bodies_each) {
    std::vector<BodyGroups> groups;
    std::vector<Aabb> boxes;
    for (std::uint32_t world = 0; world < worlds; ++world) {
      for (const Aabb& box : inputs::uniform(bodies_each, world, 1)) {
        boxes.push_back(box);
        groups.push_back({.world = world});
      }
    }
    begin("ManyWorlds", std::move(boxes), inputs::cubeRoot(10.0 * bodies_each),
          {groups, LayerMatrix().set(0, 0)});
    all_.resize(bodies_each);
    std::iota(all_.begin(), all_.end(), 0U);
  }

  [[nodiscard]] std::uint32_t worlds() const { return worlds_; }
  /// The scene of a single world.
  [[nodiscard]] SceneInfo worldScene() const {
    SceneInfo single = scene();
    single.objects = bodies_each_;
    single.filter = {};
    return single;
  }
  [[nodiscard]] Frame worldFrame(std::uint32_t world) const {
    return {frame().index, frame().boxes.subspan(std::size_t{world} * bodies_each_, bodies_each_),
            all_};
  }

 private:
  void change() override {
    for (std::uint32_t body = 0; body < size(); ++body) put(body, stepped(box(body), 0.2F));
  }

  std::uint32_t worlds_;
  std::uint32_t bodies_each_;
  std::vector<std::uint32_t> all_;
};

/// Cases that alternate frame by frame, each in its own or a shared world.
class WorldContest {
 public:
  /// Starts the case; if it cannot run, prints the reason and returns false. Borrows `world`.
  bool add(std::string name, const Case& entered, LivingWorld& world) {
    Entrant added = {
        .name = std::move(name), .host = makeInProcessExecutor(entered, {}), .world = &world};
    try {
      added.start_ns = added.host->start(world.scene(), world.frame());
    } catch (const std::exception& error) {
      std::printf("%s: %s\n", added.name.c_str(), error.what());
      return false;
    }
    if (std::ranges::find(worlds_, &world) == worlds_.end()) worlds_.push_back(&world);
    entrants_.push_back(std::move(added));
    return true;
  }

  /// Runs warm-up frames, then `rounds` measured frames.
  void run(int warm_up, int rounds) {
    std::mt19937 random;
    std::vector<std::size_t> order(entrants_.size());
    std::iota(order.begin(), order.end(), 0);
    for (int round = -warm_up; round < rounds; ++round) {
      for (LivingWorld* const world : worlds_) world->step();
      std::ranges::shuffle(order, random);
      for (const std::size_t i : order) {
        Entrant& entrant = entrants_[i];
        const StepResult result = entrant.host->step(entrant.world->frame());
        if (round < 0) continue;
        entrant.us.push_back(static_cast<double>(result.times[Phase::total]) * 1e-3);
      }
    }
  }

  struct Entrant {
    std::string name;
    std::unique_ptr<CaseExecutor> host;
    LivingWorld* world = nullptr;
    std::int64_t start_ns = 0;
    std::vector<double> us = {};  ///< total of each measured frame
  };
  [[nodiscard]] std::span<Entrant> entrants() { return entrants_; }

 private:
  std::vector<Entrant> entrants_;
  std::vector<LivingWorld*> worlds_;
};

}  // namespace broadmark::benchmarks
