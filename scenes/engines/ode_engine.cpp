// Rigid bodies by the Open Dynamics Engine (double precision): hashed grid, box and sphere
// colliders, projected Gauss-Seidel over the contacts of each island ("quick step").
//
// The quick step shuffles contacts with a process-wide random number generator. Here each world has
// its own generator state, which is installed during a step. Only one world steps at a time.

#include <ode/ode.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "broadmark/c_deleter.h"
#include "broadmark/scenes/body_pool.h"
#include "broadmark/scenes/registry.h"
#include "entries.h"

namespace broadmark::scenes::ode_engine {
namespace {

/// Contacts per pair: enough for a face on a face.
constexpr int kContactsPerPair = 4;
/// Solver sweeps per iteration in the settings. The quick step has no warm start, so it needs more
/// sweeps than other solvers.
constexpr int kSweepsPerIteration = 2;
/// Penetration at rest, so that contacts persist.
constexpr double kRestingDepth = 0.005;
/// The largest separation speed of overlapping bodies, in units per second: otherwise bodies that
/// start inside each other would explode.
constexpr double kSeparationSpeed = 2;
/// The smallest impact speed with restitution, in units per second.
constexpr double kBounceSpeed = 0.1;
/// Time of slow motion before a body falls asleep, in seconds.
constexpr double kTimeToSleep = 0.5;

using World = std::unique_ptr<dxWorld, CDeleter<dWorldDestroy>>;
using Space = std::unique_ptr<dxSpace, CDeleter<dSpaceDestroy>>;
using JointGroup = std::unique_ptr<dxJointGroup, CDeleter<dJointGroupDestroy>>;
using Body = std::unique_ptr<dxBody, CDeleter<dBodyDestroy>>;
using Geom = std::unique_ptr<dxGeom, CDeleter<dGeomDestroy>>;

/// The library must be initialised once, before its first use.
void initialiseOde() {
  static const int initialised = dInitODE2(0);
  static_cast<void>(initialised);
}

/// During its lifetime the process's random number generator continues one world's sequence.
class ScopedOdeSeed {
 public:
  explicit ScopedOdeSeed(unsigned long& seed) : seed_(seed), lock_(mutex()) { dRandSetSeed(seed_); }
  ~ScopedOdeSeed() { seed_ = dRandGetSeed(); }
  ScopedOdeSeed(const ScopedOdeSeed&) = delete;
  ScopedOdeSeed& operator=(const ScopedOdeSeed&) = delete;

 private:
  /// Guards the library's process-wide generator.
  static std::mutex& mutex() {
    static std::mutex mutex;
    return mutex;
  }

  unsigned long& seed_;
  std::lock_guard<std::mutex> lock_;
};

Vec3 fromOde(const dReal* v) {
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

class OdeBody : public PhysicsBody {
 public:
  /// `collides_with`: the layers of bodies that it pushes.
  OdeBody(const BodyDescription& description, dWorldID world, dSpaceID space,
          std::uint32_t collides_with)
      : shape_(description.shape), body_(dBodyCreate(world)) {
    dMass mass;
    std::visit([&](const auto& kind) { createGeom(kind, space, description.mass, mass); }, shape_);
    dBodySetMass(body_.get(), &mass);
    // The diagonal of three rows of four.
    mean_inertia_ = (mass.I[0] + mass.I[5] + mass.I[10]) / 3 / mass.mass;
    dGeomSetBody(geom_.get(), body_.get());
    dGeomSetData(geom_.get(), this);
    dGeomSetCategoryBits(geom_.get(), std::uint32_t{1} << description.layer);
    dGeomSetCollideBits(geom_.get(), collides_with);
    setPose(description.pose);
    setVelocity(description.linear_velocity, description.angular_velocity);
  }

  [[nodiscard]] const Shape& shape() const override { return shape_; }

  [[nodiscard]] Pose pose() const override {
    if (frozen_) return frozen_pose_;
    const dReal* q = dBodyGetQuaternion(body_.get());  // w x y z
    return {fromOde(dBodyGetPosition(body_.get())),
            {static_cast<float>(q[1]), static_cast<float>(q[2]), static_cast<float>(q[3]),
             static_cast<float>(q[0])}};
  }

  [[nodiscard]] Vec3 linearVelocity() const override {
    return fromOde(dBodyGetLinearVel(body_.get()));
  }
  [[nodiscard]] Vec3 angularVelocity() const override {
    return fromOde(dBodyGetAngularVel(body_.get()));
  }

  void setPose(const Pose& pose) override {
    const Vec3& p = pose.position;
    const auto& q = pose.rotation;
    const dQuaternion quaternion = {q[3], q[0], q[1], q[2]};
    // The geom moves its body. The geom of a frozen body moves alone.
    dGeomSetPosition(geom_.get(), p[0], p[1], p[2]);
    dGeomSetQuaternion(geom_.get(), quaternion);
    frozen_pose_ = pose;
    wake();
  }

  void setVelocity(const Vec3& linear, const Vec3& angular) override {
    if (frozen_) return;
    dBodySetLinearVel(body_.get(), linear[0], linear[1], linear[2]);
    dBodySetAngularVel(body_.get(), angular[0], angular[1], angular[2]);
    wake();
  }

  [[nodiscard]] bool asleep() const override { return dBodyIsEnabled(body_.get()) == 0; }
  [[nodiscard]] bool frozen() const override { return frozen_; }

  void freeze() override {
    if (frozen_) return;
    frozen_pose_ = pose();
    frozen_ = true;
    // A geom without a body is an immovable obstacle, and retains its pose.
    dGeomSetBody(geom_.get(), nullptr);
    stop();
  }

  /// No effect on a frozen body.
  void wake() {
    if (!frozen_) dBodyEnable(body_.get());
    slow_time_ = 0;
  }

  /// Call when a possible support has vanished: wakes the body, and marks it until findSupport().
  void loseSupport() {
    support_lost_ = !frozen_;
    wake();
  }
  void findSupport() { support_lost_ = false; }
  [[nodiscard]] bool supportLost() const { return support_lost_; }

  /// Called after every substep: puts the body to sleep after a time of low energy. The library
  /// ignores isolated bodies.
  void rest(double sleep_threshold, double time) {
    if (asleep()) return;
    const dReal* v = dBodyGetLinearVel(body_.get());
    const dReal* w = dBodyGetAngularVel(body_.get());
    const double energy = (dCalcVectorDot3(v, v) + mean_inertia_ * dCalcVectorDot3(w, w)) / 2;
    slow_time_ = energy < sleep_threshold ? slow_time_ + time : 0;
    if (slow_time_ >= kTimeToSleep) stop();
  }

  /// The body for contacts; null: immovable.
  [[nodiscard]] dBodyID dynamicBody() const { return frozen_ ? nullptr : body_.get(); }
  [[nodiscard]] dGeomID geom() const { return geom_.get(); }

  /// Calls add(point, distance) for each point of the body that may reach the wall within `time`,
  /// with its distance to the wall (negative: behind it).
  template <class Add>
  void visitWallPoints(const HalfSpace& wall, double time, const Add& add) const {
    const dVector3 normal = {wall.normal[0], wall.normal[1], wall.normal[2]};
    const dReal* centre = dBodyGetPosition(body_.get());
    const double height = dCalcVectorDot3(normal, centre) - wall.offset - bounding_radius_;
    const dReal* turning = dBodyGetAngularVel(body_.get());
    const double speed = std::max(0.0, -dCalcVectorDot3(normal, dBodyGetLinearVel(body_.get()))) +
                         dCalcVectorLength3(turning) * bounding_radius_;
    const double reach = kRestingDepth + time * speed;
    if (height > reach) return;
    for (const Vec3& local : wall_points_) {
      dVector3 point;
      dBodyGetRelPointPos(body_.get(), local[0], local[1], local[2], point);
      const double distance = dCalcVectorDot3(normal, point) - wall.offset - point_radius_;
      if (distance > reach) continue;
      for (int axis = 0; axis < 3; ++axis) point[axis] -= point_radius_ * normal[axis];
      add(point, distance);
    }
  }

 private:
  /// Creates the geom and the wall points; computes `mass`.
  void createGeom(const BoxShape& box, dSpaceID space, double total, dMass& mass) {
    const auto& [x, y, z] = box.half_extents;
    geom_.reset(dCreateBox(space, 2 * x, 2 * y, 2 * z));
    dMassSetBoxTotal(&mass, total, 2 * x, 2 * y, 2 * z);
    bounding_radius_ = std::hypot(x, y, z);
    for (unsigned corner = 0; corner < 8; ++corner) {
      Vec3& at = wall_points_.emplace_back(box.half_extents);
      for (unsigned axis = 0; axis < 3; ++axis) {
        if ((corner >> axis & 1U) != 0) at[axis] = -at[axis];
      }
    }
  }
  void createGeom(const SphereShape& sphere, dSpaceID space, double total, dMass& mass) {
    geom_.reset(dCreateSphere(space, sphere.radius));
    dMassSetSphereTotal(&mass, total, sphere.radius);
    bounding_radius_ = point_radius_ = sphere.radius;
    wall_points_ = {Vec3{}};
  }

  void stop() {
    dBodySetLinearVel(body_.get(), 0, 0, 0);
    dBodySetAngularVel(body_.get(), 0, 0, 0);
    dBodyDisable(body_.get());
  }

  Shape shape_;
  Body body_;
  Geom geom_;
  /// The points that can touch a wall first, in local coordinates: the corners of a box. For a
  /// sphere the centre represents them, with its radius.
  std::vector<Vec3> wall_points_;
  double point_radius_ = 0;  ///< of a ball around each wall point
  double bounding_radius_ = 0;
  double mean_inertia_ = 0;  ///< per mass
  double slow_time_ = 0;     ///< time since the body became slow
  bool frozen_ = false;
  bool support_lost_ = false;
  Pose frozen_pose_;
};

class OdeEngine final : public PhysicsEngine {
 public:
  explicit OdeEngine(const PhysicsSettings& settings)
      : settings_(settings),
        time_(settings.time_step / static_cast<double>(settings.substeps)),
        world_((initialiseOde(), dWorldCreate())),
        space_(dHashSpaceCreate(nullptr)),
        contacts_(dJointGroupCreate(0)) {
    dWorldID world = world_.get();
    dWorldSetQuickStepNumIterations(
        world, kSweepsPerIteration * static_cast<int>(settings.solver_iterations));
    dWorldSetContactSurfaceLayer(world, kRestingDepth);
    dWorldSetContactMaxCorrectingVel(world, kSeparationSpeed);
    dWorldSetMaxAngularSpeed(world, settings.max_angular_speed);
    dWorldSetDamping(world, lostFraction(settings.linear_damping),
                     lostFraction(settings.angular_damping));
    dWorldSetLinearDampingThreshold(world, 0);
    dWorldSetAngularDampingThreshold(world, 0);
  }

  void setLayers(const LayerMatrix& layers) override { layers_ = layers; }

  PhysicsBody& addBody(const BodyDescription& description) override {
    return bodies_.add(description, world_.get(), space_.get(), layers_.rows()[description.layer]);
  }

  void removeBody(PhysicsBody& body) override {
    auto& ode_body = static_cast<OdeBody&>(body);
    // Contacts are not retained between steps: any near body may have lost its support.
    const dGeomID space_as_geom = reinterpret_cast<dGeomID>(space_.get());
    dSpaceCollide2(ode_body.geom(), space_as_geom, nullptr, [](void*, dGeomID a, dGeomID b) {
      bodyOf(a).loseSupport();
      bodyOf(b).loseSupport();
    });
    bodies_.remove(ode_body);
    support_lost_ = true;
  }

  void addWall(const HalfSpace& wall) override { walls_.push_back(wall); }

  void setGravity(const Vec3& gravity) override {
    if (gravity == gravity_) return;
    gravity_ = gravity;
    dWorldSetGravity(world_.get(), gravity[0], gravity[1], gravity[2]);
    bodies_.each([](OdeBody& body) { body.wake(); });
  }

  [[nodiscard]] Vec3 gravity() const override { return gravity_; }

  void step() override {
    if (std::exchange(support_lost_, false)) wakeUnsupported();
    for (std::int64_t i = 0; i < settings_.substeps; ++i) {
      // Includes sleeping bodies: an awake body wakes the bodies that it touches, which need their
      // support in the same step.
      bodies_.each([this](const OdeBody& body) {
        if (!body.frozen()) touchWalls(body);
      });
      dSpaceCollide(space_.get(), this, [](void* engine, dGeomID a, dGeomID b) {
        static_cast<OdeEngine*>(engine)->touch(a, b);
      });
      {
        const ScopedOdeSeed seed(random_);
        dWorldQuickStep(world_.get(), time_);
      }
      dJointGroupEmpty(contacts_.get());
      bodies_.each([this](OdeBody& body) { body.rest(settings_.sleep_threshold, time_); });
    }
  }

  [[nodiscard]] bool allAsleep() const override {
    return bodies_.all([](const OdeBody& body) { return body.asleep(); });
  }

 private:
  /// The fraction of a velocity lost by damping in one substep.
  [[nodiscard]] double lostFraction(double per_second) const {
    return 1 - std::pow(1 - per_second, time_);
  }

  static OdeBody& bodyOf(dGeomID geom) { return *static_cast<OdeBody*>(dGeomGetData(geom)); }

  /// Wakes all bodies connected with a body that lost its support: the library lets bodies woken by
  /// others fall asleep again at once, before they have begun to fall.
  void wakeUnsupported() {
    using Near = std::vector<std::pair<OdeBody*, OdeBody*>>;
    Near near;
    dSpaceCollide(space_.get(), &near, [](void* pairs, dGeomID a, dGeomID b) {
      if (bodyOf(a).frozen() || bodyOf(b).frozen()) return;
      static_cast<Near*>(pairs)->emplace_back(&bodyOf(a), &bodyOf(b));
    });
    for (bool changed = true; changed;) {
      changed = false;
      for (const auto& [a, b] : near) {
        if (a->supportLost() == b->supportLost()) continue;
        a->loseSupport();
        b->loseSupport();
        changed = true;
      }
    }
    bodies_.each([](OdeBody& body) { body.findSupport(); });
  }

  void touch(dGeomID geom_a, dGeomID geom_b) {
    const OdeBody& a = bodyOf(geom_a);
    const OdeBody& b = bodyOf(geom_b);
    if (a.frozen() && b.frozen()) return;
    std::array<dContactGeom, kContactsPerPair> points;
    const int count =
        dCollide(geom_a, geom_b, kContactsPerPair, points.data(), sizeof(dContactGeom));
    for (int i = 0; i < count; ++i) {
      addContact(points[static_cast<std::size_t>(i)], 0, a.dynamicBody(), b.dynamicBody());
    }
  }

  /// Adds contacts with every wall that a point of the body may reach in the next substep, so that
  /// the solver stops even fast bodies at the wall.
  void touchWalls(const OdeBody& body) {
    for (const HalfSpace& wall : walls_) {
      body.visitWallPoints(wall, time_, [&](const dReal* at, double distance) {
        dContactGeom point{};
        std::copy_n(at, 3, point.pos);
        std::ranges::copy(wall.normal, point.normal);
        point.depth = std::max(0.0, kRestingDepth - distance);
        const double gap = std::max(0.0, distance - kRestingDepth);
        addContact(point, -gap / time_, body.dynamicBody(), nullptr);
      });
    }
  }

  /// `approach`: the allowed velocity of approach along the normal; 0 or negative.
  void addContact(const dContactGeom& point, double approach, dBodyID a, dBodyID b) {
    dContact contact{};
    contact.geom = point;
    contact.surface.mode = dContactApprox1;
    contact.surface.mu = settings_.friction;
    if (approach < 0) {
      contact.surface.mode |= dContactMotionN;
      contact.surface.motionN = approach;
    }
    if (settings_.restitution > 0) {
      contact.surface.mode |= dContactBounce;
      contact.surface.bounce = settings_.restitution;
      contact.surface.bounce_vel = kBounceSpeed;
    }
    dJointAttach(dJointCreateContact(world_.get(), contacts_.get(), &contact), a, b);
  }

  PhysicsSettings settings_;
  double time_;  ///< of a substep, in seconds
  unsigned long random_ = 0;
  Vec3 gravity_{};
  LayerMatrix layers_ = LayerMatrix::all();
  bool support_lost_ = false;  ///< by any body, since the last step
  World world_;
  Space space_;
  JointGroup contacts_;
  std::vector<HalfSpace> walls_;
  BodyPool<OdeBody> bodies_;
};

}  // namespace

EngineEntry entry() {
  return {{"ode", "the Open Dynamics Engine's rigid bodies (double precision)"},
          makeEntry<PhysicsEngine, OdeEngine>};
}

}  // namespace broadmark::scenes::ode_engine
