// Rigid bodies by Bullet (single precision): dynamic AABB trees, sequential impulses.
//
// This engine never changes Bullet's process-wide settings, so worlds can coexist. But the
// algorithms of the DBVT family change one of them, the tree margin. Bullet reads it whenever a
// body's box changes, so calls that change a box hold a SharedUse.

#include <btBulletDynamicsCommon.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "broadmark/exclusive_use.h"
#include "broadmark/scenes/body_pool.h"
#include "broadmark/scenes/registry.h"
#include "entries.h"

namespace broadmark::scenes::bullet_engine {
namespace {

btVector3 toBullet(const Vec3& v) { return {v[0], v[1], v[2]}; }
Vec3 fromBullet(const btVector3& v) { return {v.x(), v.y(), v.z()}; }

btTransform toBullet(const Pose& pose) {
  const auto& q = pose.rotation;
  return btTransform(btQuaternion(q[0], q[1], q[2], q[3]), toBullet(pose.position));
}

Pose fromBullet(const btTransform& transform) {
  const btQuaternion q = transform.getRotation();
  return {fromBullet(transform.getOrigin()), {q.x(), q.y(), q.z(), q.w()}};
}

/// A half-space. Its box ends at the plane if the plane is perpendicular to an axis. Bullet's own
/// plane has an infinite box, which overlaps every body of the world.
class HalfSpaceShape final : public btStaticPlaneShape {
 public:
  using btStaticPlaneShape::btStaticPlaneShape;

  void getAabb(const btTransform& transform, btVector3& min, btVector3& max) const override {
    btStaticPlaneShape::getAabb(transform, min, max);
    for (int axis = 0; axis < 3; ++axis) {
      if (m_planeNormal[axis] == 1) max[axis] = m_planeConstant;
      if (m_planeNormal[axis] == -1) min[axis] = -m_planeConstant;
    }
  }
};

/// The points of a shape that can touch a wall first, in local coordinates: the corners of a box,
/// the deepest point of a sphere.
int wallPoints(const btBoxShape& box) { return box.getNumVertices(); }
btVector3 wallPoint(const btBoxShape& box, int corner, const btVector3& /*into_wall*/) {
  btVector3 at;
  box.getVertex(corner, at);
  return at;
}
int wallPoints(const btSphereShape&) { return 1; }
btVector3 wallPoint(const btSphereShape& sphere, int, const btVector3& into_wall) {
  return sphere.getRadius() * into_wall;
}

/// Contacts of a body with a wall: one for each point that may reach the wall in the next step, so
/// that the solver stops even fast bodies. (Bullet's own algorithm finds only the nearest point,
/// and only once it touches.)
template <class BodyShape>
class WallContact final : public btCollisionAlgorithm {
 public:
  WallContact(const btCollisionAlgorithmConstructionInfo& info, const btCollisionObjectWrapper* a,
              const btCollisionObjectWrapper* b)
      : btCollisionAlgorithm(info),
        manifold_(m_dispatcher->getNewManifold(a->getCollisionObject(), b->getCollisionObject())),
        resting_threshold_(manifold_->getContactBreakingThreshold()) {}
  ~WallContact() override { m_dispatcher->releaseManifold(manifold_); }

  void processCollision(const btCollisionObjectWrapper* a, const btCollisionObjectWrapper* b,
                        const btDispatcherInfo& info, btManifoldResult*) override {
    const bool wall_is_a = a->getCollisionShape()->getShapeType() == STATIC_PLANE_PROXYTYPE;
    const btCollisionObjectWrapper& body = wall_is_a ? *b : *a;
    const btCollisionObjectWrapper& wall = wall_is_a ? *a : *b;
    const auto& shape = static_cast<const BodyShape&>(*body.getCollisionShape());
    const auto& plane = static_cast<const btStaticPlaneShape&>(*wall.getCollisionShape());
    const btVector3& normal = plane.getPlaneNormal();
    const btTransform& pose = body.getWorldTransform();
    const btVector3 into_wall = -normal * pose.getBasis();
    const btScalar reach =
        resting_threshold_ +
        info.m_timeStep *
            approachSpeed(static_cast<const btRigidBody&>(*body.getCollisionObject()), normal);
    manifold_->setContactBreakingThreshold(reach);

    const btPersistentManifold before = *manifold_;
    manifold_->clearManifold();
    for (int i = 0; i < wallPoints(shape); ++i) {
      const btVector3 at = pose * wallPoint(shape, i, into_wall);
      const btScalar distance = normal.dot(at) - plane.getPlaneConstant();
      if (distance >= reach) continue;
      const btVector3 on_wall = at - distance * normal;
      btManifoldPoint point(at, on_wall, normal, distance);
      point.m_positionWorldOnA = wall_is_a ? on_wall : at;
      point.m_positionWorldOnB = wall_is_a ? at : on_wall;
      point.m_normalWorldOnB = wall_is_a ? -normal : normal;
      point.m_combinedFriction = btManifoldResult::calculateCombinedFriction(
          a->getCollisionObject(), b->getCollisionObject());
      point.m_combinedRestitution = btManifoldResult::calculateCombinedRestitution(
          a->getCollisionObject(), b->getCollisionObject());
      point.m_index0 = i;
      warmStart(point, before);
      manifold_->addManifoldPoint(point);  // keeps the best four
    }
  }

  btScalar calculateTimeOfImpact(btCollisionObject*, btCollisionObject*, const btDispatcherInfo&,
                                 btManifoldResult*) override {
    return 1;
  }
  void getAllContactManifolds(btManifoldArray& manifolds) override {
    manifolds.push_back(manifold_);
  }

  /// Factory for Bullet.
  struct CreateFunc final : btCollisionAlgorithmCreateFunc {
    btCollisionAlgorithm* CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                   const btCollisionObjectWrapper* a,
                                                   const btCollisionObjectWrapper* b) override {
      void* memory = info.m_dispatcher1->allocateCollisionAlgorithm(sizeof(WallContact));
      return new (memory) WallContact(info, a, b);
    }
  };

 private:
  /// An upper bound of the speed at which any point of the body approaches the wall.
  static btScalar approachSpeed(const btRigidBody& body, const btVector3& normal) {
    const btScalar spin =
        body.getAngularVelocity().length() * body.getCollisionShape()->getAngularMotionDisc();
    return std::max(btScalar(0), -body.getLinearVelocity().dot(normal)) + spin;
  }

  /// Warm starts the solver with the impulses of the same point in the last step.
  static void warmStart(btManifoldPoint& point, const btPersistentManifold& before) {
    for (int i = 0; i < before.getNumContacts(); ++i) {
      const btManifoldPoint& old = before.getContactPoint(i);
      if (old.m_index0 != point.m_index0) continue;
      point.m_appliedImpulse = old.m_appliedImpulse;
      point.m_appliedImpulseLateral1 = old.m_appliedImpulseLateral1;
      point.m_appliedImpulseLateral2 = old.m_appliedImpulseLateral2;
    }
  }

  btPersistentManifold* manifold_;
  btScalar resting_threshold_;
};

/// Supported bodies are held after this time of stillness, in seconds.
constexpr btScalar kStillTime = 0.5F;
/// Radius for stillness, as a fraction of a free fall of that time.
constexpr btScalar kStillRadius = 0.25F;
/// A body is supported if contacts carry at least this fraction of its weight. The fraction varies
/// in large piles.
constexpr btScalar kMinSupport = 0.25F;
/// A body is not held if its velocities would move it out of its radius within this time, in
/// seconds. Short, since the velocities of still bodies fluctuate.
constexpr btScalar kLeaveTime = 0.1F;
/// The same for a body that touches moving bodies, which must be able to push it.
constexpr btScalar kLeaveTimeIfPushed = kStillTime;

/// Tracks how long a body has been still, within a radius of a pose. Velocities are a poor
/// criterion: with few iterations bodies of a large pile jitter, and sink slowly into those below.
class SleepTracker {
 public:
  void update(const btRigidBody& body, btScalar time_step) {
    pose_ = body.getWorldTransform();
    if (distance(body, pose_, anchor_) <= reachOf(body)) {
      still_time_ += time_step;
      return;
    }
    anchor_ = pose_;
    still_time_ = 0;
  }

  /// Must be called when the caller moves or launches the body.
  void reset() { still_time_ = 0; }

  [[nodiscard]] bool isStill() const { return still_time_ >= kStillTime; }
  /// The pose in the last update.
  [[nodiscard]] const btTransform& pose() const { return pose_; }

  /// Whether a still body's velocities would move it out of its radius within this time.
  static bool leavesWithin(btScalar time, const btRigidBody& body) {
    btScalar speed = body.getLinearVelocity().length();
    const btVector3 extents = halfExtents(body);
    for (int axis = 0; axis < 3; ++axis) {
      const btVector3 arm = body.getWorldTransform().getBasis().getColumn(axis);
      speed += extents[axis] * body.getAngularVelocity().cross(arm).length();
    }
    return speed * time > reachOf(body);
  }

 private:
  /// The radius for stillness.
  static btScalar reachOf(const btRigidBody& body) {
    // Includes motion below the sleeping threshold.
    const btScalar slow = body.getLinearSleepingThreshold() * kStillTime;
    const btScalar fall = body.getGravity().length() * kStillTime * kStillTime / 2;
    return std::max(slow, kStillRadius * fall);
  }

  static btVector3 halfExtents(const btRigidBody& body) {
    btVector3 min;
    btVector3 max;
    body.getCollisionShape()->getAabb(btTransform::getIdentity(), min, max);
    return (max - min) / 2;
  }

  /// An upper bound of the distance between any point of the body in the two poses.
  static btScalar distance(const btRigidBody& body, const btTransform& a, const btTransform& b) {
    btScalar sum = a.getOrigin().distance(b.getOrigin());
    const btVector3 extents = halfExtents(body);
    for (int axis = 0; axis < 3; ++axis) {
      sum += extents[axis] * a.getBasis().getColumn(axis).distance(b.getBasis().getColumn(axis));
    }
    return sum;
  }

  btTransform anchor_{btTransform::getIdentity()};
  btTransform pose_{btTransform::getIdentity()};
  btScalar still_time_ = 0;
};

/// State of a body beyond Bullet's, referenced by the body's user pointer.
struct BodyState {
  std::uint8_t layer = 0;
  SleepTracker stillness;
  bool held = false;       ///< in the last step: still and supported
  bool disturbed = false;  ///< in this step: touches a moving body
};

/// Collides only bodies of colliding layers. All bodies collide with the walls.
class LayerFilter final : public btOverlapFilterCallback {
 public:
  explicit LayerFilter(const LayerMatrix& layers) : layers_(layers) {}

  bool needBroadphaseCollision(btBroadphaseProxy* a, btBroadphaseProxy* b) const override {
    const BodyState* state_a = stateOf(*a);
    const BodyState* state_b = stateOf(*b);
    if (state_a == nullptr || state_b == nullptr) return true;
    return layers_.collide(state_a->layer, state_b->layer);
  }

 private:
  /// Null: a wall.
  static const BodyState* stateOf(const btBroadphaseProxy& proxy) {
    const auto& object = *static_cast<const btCollisionObject*>(proxy.m_clientObject);
    return static_cast<const BodyState*>(object.getUserPointer());
  }

  LayerMatrix layers_;
};

/// Bullet's world with a limit on angular speeds, and with piles that come to rest. In plain Bullet
/// they do not: few iterations leave some motion in each body of a large pile, and a pile sleeps in
/// Bullet only when all of its bodies are slow. Here a still and supported body is held in its
/// pose. If only such bodies touch it, it is fixed, too: the solver treats it as a wall. So a pile
/// solidifies gradually, and few iterations suffice for the rest of it.
class World final : public btDiscreteDynamicsWorld {
 public:
  World(btDispatcher* dispatcher, btBroadphaseInterface* broad_phase, btConstraintSolver* solver,
        btCollisionConfiguration* configuration, btScalar max_angular_speed)
      : btDiscreteDynamicsWorld(dispatcher, broad_phase, solver, configuration),
        max_angular_speed_(max_angular_speed) {}

  /// Support may have changed: the next step fixes no body.
  void releaseAll() { release_all_ = true; }

  /// Wakes and releases the bodies that touch this one, and all bodies connected with them: they
  /// may have been supported by it.
  void releaseNeighbours(const btRigidBody& body) {
    std::set<int> islands;  // Bullet's ids of connected components, from the last step
    const auto add = [&](const btCollisionObject& other) {
      if (!other.isStaticObject()) islands.insert(other.getIslandTag());
    };
    btDispatcher& contacts = *getDispatcher();
    for (int i = 0; i < contacts.getNumManifolds(); ++i) {
      const btPersistentManifold& contact = *contacts.getManifoldByIndexInternal(i);
      if (contact.getNumContacts() == 0) continue;
      if (contact.getBody0() == &body) add(*contact.getBody1());
      if (contact.getBody1() == &body) add(*contact.getBody0());
    }
    if (islands.empty()) return;
    forEachBody([&](btRigidBody& other) {
      if (other.isStaticObject() || !islands.contains(other.getIslandTag())) return;
      stateOf(other).held = false;
      other.activate();
    });
  }

 protected:
  void solveConstraints(btContactSolverInfo& settings) override {
    markDisturbed();
    const bool release_all = std::exchange(release_all_, false);
    forEachBody([&](btRigidBody& body) {
      if (release_all || stateOf(body).disturbed) stateOf(body).held = false;
      if (!stateOf(body).held) return;
      scaleImpulses(body, 0);
      body.clearForces();
    });
    btDiscreteDynamicsWorld::solveConstraints(settings);
    forEachBody([](btRigidBody& body) { scaleImpulses(body, 1); });
  }

  void integrateTransforms(btScalar time_step) override {
    forEachBody([&](btRigidBody& body) {
      limitAngularSpeed(body);
      bool& held = stateOf(body).held;
      held = held || canBeHeld(body, time_step);
      if (!held) return;
      body.setLinearVelocity(btVector3(0, 0, 0));
      body.setAngularVelocity(btVector3(0, 0, 0));
    });
    btDiscreteDynamicsWorld::integrateTransforms(time_step);
    forEachBody([&](btRigidBody& body) {
      // Restores the exact pose: the solver pushes bodies apart, and integration rounds.
      if (stateOf(body).held) body.setCenterOfMassTransform(stateOf(body).stillness.pose());
      if (body.isActive()) stateOf(body).stillness.update(body, time_step);
    });
  }

 private:
  template <class Action>
  void forEachBody(const Action& action) {
    for (int i = 0; i < m_nonStaticRigidBodies.size(); ++i) action(*m_nonStaticRigidBodies[i]);
  }

  static BodyState& stateOf(const btCollisionObject& body) {
    return *static_cast<BodyState*>(body.getUserPointer());
  }

  static void scaleImpulses(btRigidBody& body, btScalar share) {
    body.setLinearFactor(btVector3(share, share, share));
    body.setAngularFactor(share);
  }

  void markDisturbed() {
    forEachBody([](btRigidBody& body) { stateOf(body).disturbed = false; });
    btDispatcher& contacts = *getDispatcher();
    for (int i = 0; i < contacts.getNumManifolds(); ++i) {
      const btPersistentManifold& contact = *contacts.getManifoldByIndexInternal(i);
      if (contact.getNumContacts() == 0) continue;
      const btCollisionObject& a = *contact.getBody0();
      const btCollisionObject& b = *contact.getBody1();
      if (a.isStaticObject() || b.isStaticObject()) continue;
      if (!stateOf(a).stillness.isStill()) stateOf(b).disturbed = true;
      if (!stateOf(b).stillness.isStill()) stateOf(a).disturbed = true;
    }
  }

  void limitAngularSpeed(btRigidBody& body) const {
    const btVector3& velocity = body.getAngularVelocity();
    const btScalar speed_squared = velocity.length2();
    if (speed_squared > max_angular_speed_ * max_angular_speed_) {
      body.setAngularVelocity(velocity * (max_angular_speed_ / btSqrt(speed_squared)));
    }
  }

  /// Whether the body has been still long enough, and is supported.
  [[nodiscard]] static bool canBeHeld(const btRigidBody& body, btScalar time_step) {
    const BodyState& state = stateOf(body);
    if (!body.isActive() || !state.stillness.isStill()) return false;
    if (SleepTracker::leavesWithin(state.disturbed ? kLeaveTimeIfPushed : kLeaveTime, body))
      return false;
    const btScalar free_fall = body.getGravity().length2() * time_step;
    return body.getLinearVelocity().dot(body.getGravity()) < (1 - kMinSupport) * free_fall;
  }

  btScalar max_angular_speed_;
  bool release_all_ = false;
};

class BulletBody : public PhysicsBody {
 public:
  BulletBody(const BodyDescription& description,
             const btRigidBody::btRigidBodyConstructionInfo& info, World& world)
      : shape_(description.shape), world_(world), body_(info) {
    state_.layer = description.layer;
    body_.setUserPointer(&state_);
    body_.setLinearVelocity(toBullet(description.linear_velocity));
    body_.setAngularVelocity(toBullet(description.angular_velocity));
    world_.addRigidBody(&body_);
  }

  [[nodiscard]] const Shape& shape() const override { return shape_; }
  [[nodiscard]] Pose pose() const override { return fromBullet(body_.getWorldTransform()); }
  [[nodiscard]] Vec3 linearVelocity() const override {
    return fromBullet(body_.getLinearVelocity());
  }
  [[nodiscard]] Vec3 angularVelocity() const override {
    return fromBullet(body_.getAngularVelocity());
  }

  void setPose(const Pose& pose) override {
    body_.setWorldTransform(toBullet(pose));
    body_.setInterpolationWorldTransform(body_.getWorldTransform());
    const SharedUse margin(kBulletTreeMargin);
    world_.updateSingleAabb(&body_);
    wake();
  }

  void setVelocity(const Vec3& linear, const Vec3& angular) override {
    if (frozen()) return;
    body_.setLinearVelocity(toBullet(linear));
    body_.setAngularVelocity(toBullet(angular));
    wake();
  }

  [[nodiscard]] bool asleep() const override { return !body_.isActive(); }
  [[nodiscard]] bool frozen() const override { return body_.isStaticObject(); }

  void freeze() override {
    body_.setLinearVelocity(btVector3(0, 0, 0));
    body_.setAngularVelocity(btVector3(0, 0, 0));
    body_.setInterpolationLinearVelocity(btVector3(0, 0, 0));
    body_.setInterpolationAngularVelocity(btVector3(0, 0, 0));
    body_.setInterpolationWorldTransform(body_.getWorldTransform());
    // A body without mass is static. Unlike a kinematic one it lets its neighbours sleep.
    body_.setMassProps(0, btVector3(0, 0, 0));
    body_.updateInertiaTensor();
    body_.forceActivationState(ISLAND_SLEEPING);
  }

  /// Removes itself from the world, and wakes the bodies that it touches.
  void leave() {
    world_.releaseNeighbours(body_);
    world_.removeRigidBody(&body_);
  }
  /// Whether the body was recently too fast to fall asleep.
  [[nodiscard]] bool isRestless() const { return body_.getActivationState() == ACTIVE_TAG; }
  /// No effect on a frozen body.
  void wake() {
    state_.stillness.reset();
    world_.releaseAll();
    body_.activate();
  }

 private:
  Shape shape_;
  World& world_;
  BodyState state_;
  btRigidBody body_;
};

/// By default Bullet preallocates thousands of contacts: too many for thousands of worlds. Beyond
/// the preallocation it allocates on demand.
btDefaultCollisionConstructionInfo smallPools() {
  btDefaultCollisionConstructionInfo info;
  info.m_defaultMaxPersistentManifoldPoolSize = 64;
  info.m_defaultMaxCollisionAlgorithmPoolSize = 64;
  return info;
}

class BulletEngine final : public PhysicsEngine {
 public:
  explicit BulletEngine(const PhysicsSettings& settings) : settings_(settings) {
    // Bullet multiplies the values of the two bodies in contact.
    material_friction_ = static_cast<btScalar>(std::sqrt(settings.friction));
    material_restitution_ = static_cast<btScalar>(std::sqrt(settings.restitution));
    world_.setGravity(btVector3(0, 0, 0));
    btContactSolverInfo& solver = world_.getSolverInfo();
    solver.m_numIterations = static_cast<int>(settings.solver_iterations);
    // With friction in one direction only, Bullet's default, piles creep sideways.
    solver.m_solverMode |= SOLVER_USE_2_FRICTION_DIRECTIONS;
    // Find all pairs in one pass over the tree, and optimise the tree incrementally: with many
    // moving bodies faster than one query per body (docs/generator.md).
    broad_phase_.m_deferedcollide = true;
    broad_phase_.m_dupdates = 1;
    // Skip the boxes of sleeping bodies; setPose() updates them.
    world_.setForceUpdateAllAabbs(false);
    registerWallContact(BOX_SHAPE_PROXYTYPE, box_wall_contact_);
    registerWallContact(SPHERE_SHAPE_PROXYTYPE, sphere_wall_contact_);
  }

  ~BulletEngine() override {
    // Bullet would traverse all pairs for each body: remove the pairs first.
    btOverlappingPairCache& pairs = *broad_phase_.getOverlappingPairCache();
    while (pairs.getNumOverlappingPairs() > 0) {
      const btBroadphasePair& last =
          pairs.getOverlappingPairArrayPtr()[pairs.getNumOverlappingPairs() - 1];
      pairs.removeOverlappingPair(last.m_pProxy0, last.m_pProxy1, &dispatcher_);
    }
  }

  BulletEngine(const BulletEngine&) = delete;
  BulletEngine& operator=(const BulletEngine&) = delete;

  void setLayers(const LayerMatrix& layers) override {
    if (layers == LayerMatrix::all()) return;
    layer_filter_.emplace(layers);
    broad_phase_.getOverlappingPairCache()->setOverlapFilterCallback(&*layer_filter_);
  }

  PhysicsBody& addBody(const BodyDescription& description) override {
    btCollisionShape& shape =
        std::visit([this](const auto& kind) -> btCollisionShape& { return collisionShape(kind); },
                   description.shape);
    const auto mass = static_cast<btScalar>(description.mass);
    btVector3 inertia;
    shape.calculateLocalInertia(mass, inertia);
    btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, &shape, inertia);
    info.m_startWorldTransform = toBullet(description.pose);
    info.m_friction = material_friction_;
    info.m_restitution = material_restitution_;
    info.m_linearDamping = static_cast<btScalar>(settings_.linear_damping);
    info.m_angularDamping = static_cast<btScalar>(settings_.angular_damping);
    setSleepingThresholds(info);
    return bodies_.add(description, info, world_);
  }

  void removeBody(PhysicsBody& body) override {
    auto& bullet_body = static_cast<BulletBody&>(body);
    bullet_body.leave();
    bodies_.remove(bullet_body);
  }

  void addWall(const HalfSpace& half_space) override {
    auto& shape = wall_shapes_.emplace_back(toBullet(half_space.normal), half_space.offset);
    btCollisionObject& wall = walls_.emplace_back();
    wall.setCollisionShape(&shape);
    wall.setFriction(material_friction_);
    wall.setRestitution(material_restitution_);
    world_.addCollisionObject(&wall);
  }

  void setGravity(const Vec3& gravity) override {
    if (toBullet(gravity) == world_.getGravity()) return;
    // Bullet moves only bodies that are awake.
    bodies_.each([](BulletBody& body) { body.wake(); });
    world_.setGravity(toBullet(gravity));
  }

  [[nodiscard]] Vec3 gravity() const override { return fromBullet(world_.getGravity()); }

  void step() override {
    const double substep = settings_.time_step / static_cast<double>(settings_.substeps);
    // Separate calls: Bullet's own division of a step depends on rounding.
    for (std::int64_t i = 0; i < settings_.substeps; ++i) {
      const SharedUse margin(kBulletTreeMargin);
      world_.stepSimulation(static_cast<btScalar>(substep), 0);
    }
  }

  [[nodiscard]] bool allAsleep() const override {
    // When all bodies are ready to sleep, Bullet lets them sleep in the next step, except isolated
    // bodies.
    return bodies_.all([](const BulletBody& body) { return !body.isRestless(); });
  }

 private:
  void registerWallContact(int shape_type, btCollisionAlgorithmCreateFunc& contact) {
    dispatcher_.registerCollisionCreateFunc(shape_type, STATIC_PLANE_PROXYTYPE, &contact);
    dispatcher_.registerCollisionCreateFunc(STATIC_PLANE_PROXYTYPE, shape_type, &contact);
  }

  // Bodies of the same size share a shape.
  btCollisionShape& collisionShape(const BoxShape& box) {
    return box_shapes_.try_emplace(box.half_extents, toBullet(box.half_extents)).first->second;
  }
  btCollisionShape& collisionShape(const SphereShape& sphere) {
    return sphere_shapes_.try_emplace(sphere.radius, sphere.radius).first->second;
  }

  /// Bullet compares speeds, not energies: sets the speeds at which the linear or angular motion
  /// alone has the threshold's energy.
  void setSleepingThresholds(btRigidBody::btRigidBodyConstructionInfo& info) const {
    const auto speed = static_cast<btScalar>(std::sqrt(2 * settings_.sleep_threshold));
    const btVector3& inertia = info.m_localInertia;
    const btScalar mean_inertia = (inertia.x() + inertia.y() + inertia.z()) / 3;
    info.m_linearSleepingThreshold = speed;
    info.m_angularSleepingThreshold = speed * std::sqrt(info.m_mass / mean_inertia);
  }

  PhysicsSettings settings_;
  btScalar material_friction_ = 0;
  btScalar material_restitution_ = 0;
  WallContact<btBoxShape>::CreateFunc box_wall_contact_;
  WallContact<btSphereShape>::CreateFunc sphere_wall_contact_;
  btDefaultCollisionConfiguration configuration_{smallPools()};
  btCollisionDispatcher dispatcher_{&configuration_};
  std::optional<LayerFilter> layer_filter_;
  btDbvtBroadphase broad_phase_;
  btSequentialImpulseConstraintSolver solver_;
  std::map<Vec3, btBoxShape> box_shapes_;
  std::map<float, btSphereShape> sphere_shapes_;
  std::deque<HalfSpaceShape> wall_shapes_;
  std::deque<btCollisionObject> walls_;
  BodyPool<BulletBody> bodies_;
  // Last member, destroyed first: its destructor uses the other members.
  World world_{&dispatcher_, &broad_phase_, &solver_, &configuration_,
               static_cast<btScalar>(settings_.max_angular_speed)};
};

}  // namespace

EngineEntry entry() {
  return {{"bullet", "Bullet's rigid bodies (single precision)"},
          makeEntry<PhysicsEngine, BulletEngine>};
}

}  // namespace broadmark::scenes::bullet_engine
