#include "physics_simulation.h"

#include "broadmark/scenes/authored_simulation.h"

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
  bodies_.clear();
  masses_.clear();
  engine_ = createEngine();
  addWalls();
  bodies_.reserve(info_.objects);
  masses_.reserve(info_.objects);
  start();
  index_ = 0;
  return record();
}

std::optional<Frame> PhysicsSimulation::next() {
  if (!engine_) rewind();
  if (index_ == info_.frames) return {};
  ++index_;
  if (!engine_->allAsleep()) {
    engine_->step();
    freezeEscapees();
  }
  const Frame frame = record();
  act(index_);
  return frame;
}

std::span<const Aabb> PhysicsSimulation::unturnedBoxes() {
  unturned_.resize(bodies_.size());
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    unturned_[i] = tightBox(bodies_[i]->shape(), {.position = poses_[i].position});
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
  scene.bodies.reserve(bodies_.size());
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const PhysicsBody& body = *bodies_[i];
    scene.bodies.push_back({.shape = body.shape(),
                            .mass = masses_[i],
                            .frozen = body.frozen(),
                            .pose = body.pose(),
                            .linear_velocity = body.linearVelocity(),
                            .angular_velocity = body.angularVelocity()});
  }
  return scene;
}

PhysicsBody& PhysicsSimulation::addBody(const BodyDescription& description) {
  bodies_.push_back(&engine_->addBody(description));
  masses_.push_back(description.mass);
  return *bodies_.back();
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
  for (PhysicsBody* body : bodies_) {
    if (!body->frozen() && !contains(info_.world, body->pose().position)) body->freeze();
  }
}

Frame PhysicsSimulation::record() {
  boxes_.resize(bodies_.size());
  poses_.resize(bodies_.size());
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    poses_[i] = bodies_[i]->pose();
    boxes_[i] = tightBox(bodies_[i]->shape(), poses_[i]);
  }
  return {index_, boxes_};
}

}  // namespace broadmark::scenes
