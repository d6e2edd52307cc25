#include "physics_simulation.h"

#include "authoring/faults.h"
#include "broadmark/scenes/authored_simulation.h"
#include "engines/worlds_engine.h"

namespace broadmark::scenes {
namespace {

bool contains(const Aabb& box, const Vec3& point) {
  for (int axis = 0; axis < 3; ++axis) {
    if (point[axis] < box.min[axis] || point[axis] > box.max[axis]) return false;
  }
  return true;
}

}  // namespace

const SceneInfo& PhysicsSimulation::scene() const {
  // Until the first frame the parameters may still change.
  if (!engine_) info_ = describe();
  return info_;
}

Frame PhysicsSimulation::rewind() {
  info_ = describe();
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
  // Not before: until now the bodies had to be those of the frame handed out last.
  if (index_ > 0) act(index_);
  ++index_;
  if (!engine_->allAsleep()) {
    engine_->step();
    freezeEscapees();
  }
  comeAndGo(index_);
  return bodies_->record(index_);
}

std::span<const Aabb> PhysicsSimulation::unturnedBoxes() {
  const auto boxes = bodies_->boxes();
  unturned_.assign(boxes.begin(), boxes.end());
  for (const std::uint32_t id : bodies_->inEngine()) {
    unturned_[id] = tightBox((*bodies_)[id]->shape(), {.position = bodies_->poses()[id].position});
  }
  return unturned_;
}

AuthoredScene PhysicsSimulation::authoredScene() {
  if (!engine_) rewind();
  AuthoredScene scene{
      .name = info_.name,
      .world = info_.world,
      .parameters = AuthoredParameters(parameterValues(*this), engine_->gravity()).values(),
      .bodies = {}};
  takeCollisions(scene, info_.filter);
  const LayerMatrix layers = pushing(info_);
  for (std::uint32_t id = 0; id < bodies_->size(); ++id) {
    const std::uint8_t layer = info_.filter.groupsOf(id).layer;
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
      scene.bodies.push_back(bodyIn(box, info_.object_type));
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
    engine_ = makeWorlds([this] { return createEngine(); });
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
    if (!contains(info_.world, body->pose().position)) body->freeze();
  }
}

}  // namespace broadmark::scenes
