// Worlds that change by themselves, frame by frame, and algorithms that take turns in them.
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

/// Boxes that change a little in every frame, and which did.
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
  /// Sets boxes by put().
  virtual void change() = 0;

  /// Fills the slots; the world is the cube of this side.
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

  [[nodiscard]] std::uint32_t anybody() {
    return std::uniform_int_distribution<std::uint32_t>(0, size() - 1)(random_);
  }
  [[nodiscard]] float number(float low, float high) {
    return std::uniform_real_distribution<float>(low, high)(random_);
  }
  /// A unit cube anywhere.
  [[nodiscard]] Aabb anywhere() {
    return inputs::boxAt({number(0, side_), number(0, side_), number(0, side_)}, {1, 1, 1});
  }
  /// The unit cube that a step of up to `most` on each axis leads to, within the world.
  [[nodiscard]] Aabb stepped(const Aabb& box, float most) {
    const auto moved = [&](std::size_t axis) {
      return std::clamp(box.min[axis] + number(-most, most), 0.0F, side_);
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

/// Unit cubes, a tenth of the space: nearly all stand still and, with `layers`, do not meet each
/// other; the last ones wander about.
class StaticLevel final : public LivingWorld {
 public:
  StaticLevel(std::uint32_t still, std::uint32_t movers, bool layers = true) : movers_(movers) {
    const std::uint32_t all = still + movers;
    std::vector<BodyGroups> groups(all);
    for (std::uint32_t body = still; body < all; ++body) groups[body].layer = 1;
    begin("StaticLevel", inputs::uniform(all, 0, 1), inputs::cubeRoot(10.0 * all),
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

/// In every frame other bodies move, and others stay where they are; or all move.
class SomeMove final : public LivingWorld {
 public:
  SomeMove(std::span<const Aabb> boxes, std::uint32_t movers) : movers_(movers) {
    begin("SomeMove", boxes, inputs::cubeRoot(10.0 * static_cast<double>(boxes.size())));
  }

 private:
  void change() override {
    for (std::uint32_t i = 0; i < movers_; ++i) {
      const std::uint32_t body = movers_ == size() ? i : anybody();
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

/// In every frame some bodies vanish, and as many appear elsewhere, in slots that are free.
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
      do slot = anybody();
      while (isEmpty(box(slot)));
      put(slot, kEmptyBox);
    }
    for (const std::uint32_t slot : arriving) put(slot, anywhere());
  }

  std::vector<std::uint32_t> free_;
};

/// Small worlds, all at the same place.
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
  /// One of the worlds, as if there were no other.
  [[nodiscard]] SceneInfo sceneOfOne() const {
    SceneInfo one = scene();
    one.objects = bodies_each_;
    one.filter = {};
    return one;
  }
  [[nodiscard]] Frame frameOfOne(std::uint32_t world) const {
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

/// Cases that take turns, a frame each; each is in a world of its own or shares one.
class WorldContest {
 public:
  /// Begins the case; false, and why is printed, if it cannot run. `world` is borrowed.
  bool add(std::string name, const Case& entered, LivingWorld& world) {
    Entrant added = {.name = std::move(name), .host = makeLocalHost(entered, {}), .world = &world};
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

  /// Frames that are not measured, then `rounds` that are.
  void run(int unmeasured, int rounds) {
    std::mt19937 random;
    std::vector<std::size_t> order(entrants_.size());
    std::iota(order.begin(), order.end(), 0);
    for (int round = -unmeasured; round < rounds; ++round) {
      for (LivingWorld* const world : worlds_) world->step();
      std::ranges::shuffle(order, random);
      for (const std::size_t turn : order) {
        Entrant& entrant = entrants_[turn];
        const StepResult run = entrant.host->step(entrant.world->frame());
        if (round < 0) continue;
        entrant.us.push_back(static_cast<double>(run.times[Phase::total]) * 1e-3);
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
