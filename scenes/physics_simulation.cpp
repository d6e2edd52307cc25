#include "physics_simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <functional>
#include <map>
#include <new>
#include <unordered_map>
#include <utility>

#include "authoring/faults.h"
#include "broadmark/error.h"
#include "broadmark/scenes/authored_simulation.h"
#include "broadmark/scenes/engine_observer.h"
#include "broadmark/scenes/registry.h"
#include "entries.h"

namespace broadmark::scenes {
namespace {

std::unique_ptr<PhysicsEngine> engineOf(const std::string& id, const PhysicsSettings& settings) {
  return entryOf(engineEntries(), id, "physics engine").create(settings);
}

using EngineMaker = std::function<std::unique_ptr<PhysicsEngine>()>;

/// An engine for each world, created with its first body. A single engine would have to test
/// every pair of bodies at the same place, although nearly all are in different worlds.
class WorldsEngine final : public PhysicsEngine {
 public:
  explicit WorldsEngine(EngineMaker make_engine) : make_engine_(std::move(make_engine)) {}

  void setLayers(const LayerMatrix& layers) override { layers_ = layers; }

  PhysicsBody& addBody(const BodyDescription& description) override {
    PhysicsEngine& world = worldOf(description.world);
    PhysicsBody& body = world.addBody(description);
    world_of_body_[&body] = &world;
    return body;
  }

  void removeBody(PhysicsBody& body) override {
    const auto found = world_of_body_.find(&body);
    found->second->removeBody(body);
    world_of_body_.erase(found);
  }

  void addWall(const HalfSpace& wall) override {
    walls_.push_back(wall);
    for (auto& [number, world] : worlds_) world->addWall(wall);
  }

  void setGravity(const Vec3& gravity) override {
    gravity_ = gravity;
    for (auto& [number, world] : worlds_) world->setGravity(gravity);
  }
  [[nodiscard]] Vec3 gravity() const override { return gravity_; }

  void step() override {
    for (auto& [number, world] : worlds_) {
      if (!world->allAsleep()) world->step();
    }
  }

  [[nodiscard]] bool allAsleep() const override {
    return std::ranges::all_of(worlds_,
                               [](const auto& world) { return world.second->allAsleep(); });
  }

 private:
  PhysicsEngine& worldOf(std::uint32_t number) {
    auto& world = worlds_[number];
    if (!world) {
      world = make_engine_();
      if (layers_) world->setLayers(*layers_);
      for (const HalfSpace& wall : walls_) world->addWall(wall);
      world->setGravity(gravity_);
    }
    return *world;
  }

  EngineMaker make_engine_;
  std::optional<LayerMatrix> layers_;
  std::vector<HalfSpace> walls_;
  Vec3 gravity_{};
  std::map<std::uint32_t, std::unique_ptr<PhysicsEngine>> worlds_;  ///< by number
  std::unordered_map<const PhysicsBody*, PhysicsEngine*> world_of_body_;
};

EngineObserver* observer = nullptr;

/// Notifies the observer of a call.
class ObservedCall {
 public:
  explicit ObservedCall(const std::string& what) {
    if (observer != nullptr) observer->onCallStart(what);
  }
  ~ObservedCall() {
    if (observer != nullptr) observer->onCallEnd();
  }
  ObservedCall(const ObservedCall&) = delete;
  ObservedCall& operator=(const ObservedCall&) = delete;
};

/// An engine with its plug-in; "" if it is built in.
std::string pluginEngine(const std::string& id) {
  for (const EngineListing& engine : availableEngines()) {
    if (engine.id == id && !engine.plugin.empty()) {
      return fmt::format("engine '{}' of {}", id, engine.plugin);
    }
  }
  return {};
}

}  // namespace

void observeEngines(EngineObserver& new_observer) { observer = &new_observer; }

Parametrised& ChosenEngine::parameters(const std::string& id, const PhysicsSettings& settings) {
  if (!engine_ || id_ != id) {
    engine_ = engineOf(id, settings);
    id_ = id;
  }
  return *engine_;
}

std::unique_ptr<PhysicsEngine> ChosenEngine::create(const std::string& id,
                                                    const PhysicsSettings& settings) {
  auto engine = engineOf(id, settings);
  setParameters(*engine, parameterValues(parameters(id, settings)));
  return engine;
}

const SceneInfo& PhysicsSimulation::scene() const {
  // The parameters may change until the first frame.
  if (!engine_) info_ = describe();
  return info_;
}

template <class Call>
auto PhysicsSimulation::guarded(std::uint32_t frame, const Call& call) {
  if (plugin_engine_.empty()) return call();
  const std::string what = fmt::format("{}: {}, frame {}", plugin_engine_, info_.name, frame);
  const ObservedCall observed(what);
  try {
    return call();
  } catch (const InputError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    throw InputError(fmt::format("{}: exception: {}", what, error.what()));
  } catch (...) {
    throw InputError(fmt::format("{}: exception of an unknown type", what));
  }
}

Frame PhysicsSimulation::rewind() {
  info_ = describe();
  escapes_.clear();
  plugin_engine_ = pluginEngine(parameterValues(*this).at("engine"));
  return guarded(0, [this] { return restart(); });
}

Frame PhysicsSimulation::restart() {
  bodies_.reset();
  makeEngine();
  bodies_.emplace(*engine_, info_);
  start();
  index_ = 0;
  return bodies_->record(index_);
}

std::optional<Frame> PhysicsSimulation::next() {
  if (!engine_) rewind();
  if (index_ == info_.frames) return {};
  return guarded(index_ + 1, [this] { return advance(); });
}

Frame PhysicsSimulation::advance() {
  // Deferred until now, since the bodies had to match the last frame.
  if (index_ > 0) act(index_);
  ++index_;
  if (!engine_->allAsleep()) {
    engine_->step();
    freezeEscapees();
  }
  updatePresence(index_);
  return bodies_->record(index_);
}

std::span<const Aabb> PhysicsSimulation::unrotatedBoxes() {
  const auto boxes = bodies_->boxes();
  unrotated_.assign(boxes.begin(), boxes.end());
  for (const std::uint32_t id : bodies_->inEngine()) {
    unrotated_[id] = tightBox((*bodies_)[id]->shape(), {.position = bodies_->poses()[id].position});
  }
  return unrotated_;
}

AuthoredScene PhysicsSimulation::authoredScene() {
  if (!engine_) rewind();
  AuthoredScene scene{
      .name = info_.name,
      .world = info_.world,
      .parameters = AuthoredParameters(parameterValues(*this), engine_->gravity()).values(),
      .bodies = {}};
  copyCollisions(scene, info_.filter);
  const LayerMatrix layers = pushing(info_);
  for (std::uint32_t id = 0; id < bodies_->size(); ++id) {
    const std::uint8_t layer = bodies_->filter().groupsOf(id).layer;
    bool pushes = layers.rows()[layer] != 0;
    if (const PhysicsBody* body = (*bodies_)[id]) {
      scene.bodies.push_back({.shape = body->shape(),
                              .mass = bodies_->massOf(id),
                              .frozen = body->frozen(),
                              .pose = body->pose(),
                              .linear_velocity = body->linearVelocity(),
                              .angular_velocity = body->angularVelocity(),
                              .layer = layer});
    } else if (const Aabb& box = bodies_->boxes()[id]; !isEmpty(box)) {
      scene.bodies.push_back(bodyFilling(box, info_.object_type));
      scene.bodies.back().frozen = true;
      scene.bodies.back().layer = layer;
      pushes = false;
    } else {
      continue;
    }
    if (!pushes) scene.triggers |= std::uint32_t{1} << layer;
  }
  return scene;
}

void PhysicsSimulation::makeEngine() {
  if (info_.filter.worlds().empty()) {
    engine_ = createEngine();
  } else {
    engine_ = std::make_unique<WorldsEngine>([this] { return createEngine(); });
  }
  const LayerMatrix layers = pushing(info_);
  const bool all_push = info_.filter.layers().empty() && layers.collide(0, 0);
  if (!all_push) engine_->setLayers(layers);
  addWalls();
}

void PhysicsSimulation::addWalls() {
  for (int axis = 0; axis < 3; ++axis) {
    HalfSpace low{.offset = info_.world.min[axis]};
    low.normal[axis] = 1;
    HalfSpace high{.offset = -info_.world.max[axis]};
    high.normal[axis] = -1;
    engine_->addWall(low);
    engine_->addWall(high);
  }
}

void PhysicsSimulation::freezeEscapees() {
  for (const std::uint32_t id : bodies_->inEngine()) {
    PhysicsBody* body = (*bodies_)[id];
    if (body == nullptr || body->frozen()) continue;
    if (contains(info_.world, boxAround(body->pose().position, {}))) continue;
    body->freeze();
    escapes_.push_back({id, index_});
  }
}

}  // namespace broadmark::scenes
