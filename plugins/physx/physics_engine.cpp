// Rigid bodies by PhysX: persistent contact manifolds, a solver over islands, which fall asleep by
// their energy.
//
// Temporal Gauss-Seidel ("TGS"), which PhysX advises where masses and sizes differ, kept bodies of
// all sizes that start inside each other from sinking into each other; speculative contacts did
// not.
//
// One thread: the generator bakes a scene on each core. With enhanced determinism the same calls
// give the same bits.

#include "broadmark/scenes/physics_engine.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <variant>
#include <vector>

#include "broadmark/scenes/body_pool.h"
#include "broadmark/scenes/engine_plugin.h"
#include "damping.h"
#include "physx/library.h"

namespace broadmark::scenes::physx_engine {
namespace {

/// The smallest speed of an impact that bounces, in units per second.
constexpr float kBounceSpeed = 0.1F;
/// The largest speed at which overlapping bodies are pushed apart, in units per second: otherwise
/// bodies that start inside each other would explode.
constexpr float kSeparationSpeed = 5;

/// How near bodies are when PhysX begins to look at their contact: so a body of usual speed is
/// stopped at a wall, not in it.
constexpr float kContactOffset = 0.1F;
/// Bodies that move further than this towards each other in a substep are swept: nothing gets
/// behind a wall. By itself PhysX goes by the size of the shapes, which for a wall is huge.
constexpr float kSweptWay = 0.4F;

template <class Object>
using Released = std::unique_ptr<Object, ReleasePhysX>;

/// PhysX's factory, of which a process has one: for as long as it runs.
physx::PxPhysics& factory() {
  static physx::PxPhysics* const physics =
      PxCreatePhysics(PX_PHYSICS_VERSION, physXFoundation(), physx::PxTolerancesScale());
  if (physics == nullptr) throw UnsupportedError("PhysX: creates no physics");
  return *physics;
}

physx::PxVec3 toPhysX(const Vec3& v) { return {v[0], v[1], v[2]}; }
Vec3 fromPhysX(const physx::PxVec3& v) { return {v.x, v.y, v.z}; }
physx::PxTransform toPhysX(const Pose& pose) {
  const auto& q = pose.rotation;
  return {toPhysX(pose.position), physx::PxQuat(q[0], q[1], q[2], q[3]).getNormalized()};
}

physx::PxBoxGeometry geometryOf(const BoxShape& box) {
  return physx::PxBoxGeometry(toPhysX(box.half_extents));
}
physx::PxSphereGeometry geometryOf(const SphereShape& sphere) {
  return physx::PxSphereGeometry(sphere.radius);
}

/// Of a body: its layer, the layers that it pushes, and 0. Of a wall: 0, 0 and 1.
using Layers = physx::PxFilterData;

physx::PxFilterFlags whetherToCollide(physx::PxFilterObjectAttributes, Layers a,
                                      physx::PxFilterObjectAttributes, Layers b,
                                      physx::PxPairFlags& pair, const void*, physx::PxU32) {
  pair = physx::PxPairFlag::eCONTACT_DEFAULT | physx::PxPairFlag::eDETECT_CCD_CONTACT;
  const bool is_wall = (a.word2 | b.word2) != 0;
  return is_wall || (a.word1 & b.word0) != 0 ? physx::PxFilterFlag::eDEFAULT
                                             : physx::PxFilterFlag::eSUPPRESS;
}

class PhysXBody : public PhysicsBody {
 public:
  /// `scene` and `material` are borrowed. `pushes`: the layers that it pushes.
  PhysXBody(const BodyDescription& description, const PhysicsSettings& settings,
            physx::PxScene& scene, physx::PxMaterial& material, std::uint32_t pushes)
      : shape_(description.shape), scene_(scene) {
    actor_.reset(factory().createRigidDynamic(toPhysX(description.pose)));
    physx::PxShape* const shape = std::visit(
        [&](const auto& kind) {
          return physx::PxRigidActorExt::createExclusiveShape(*actor_, geometryOf(kind), material);
        },
        shape_);
    shape->setContactOffset(kContactOffset);
    shape->setSimulationFilterData(Layers(1U << description.layer, pushes, 0, 0));
    physx::PxRigidBodyExt::setMassAndUpdateInertia(*actor_, static_cast<float>(description.mass));
    actor_->setLinearDamping(dampingFactor(settings.linear_damping));
    actor_->setAngularDamping(dampingFactor(settings.angular_damping));
    actor_->setMaxAngularVelocity(static_cast<float>(settings.max_angular_speed));
    actor_->setMaxDepenetrationVelocity(kSeparationSpeed);
    actor_->setSleepThreshold(static_cast<float>(settings.sleep_threshold));
    // PhysX takes no more than 255.
    actor_->setSolverIterationCounts(
        static_cast<physx::PxU32>(std::min<std::int64_t>(settings.solver_iterations, 255)));
    actor_->setRigidBodyFlag(physx::PxRigidBodyFlag::eENABLE_CCD, true);
    scene_.addActor(*actor_);
    actor_->setLinearVelocity(toPhysX(description.linear_velocity));
    actor_->setAngularVelocity(toPhysX(description.angular_velocity));
  }
  PhysXBody(const PhysXBody&) = delete;
  PhysXBody& operator=(const PhysXBody&) = delete;
  ~PhysXBody() override { scene_.removeActor(*actor_); }  // wakes those that it touched

  [[nodiscard]] const Shape& shape() const override { return shape_; }
  [[nodiscard]] Pose pose() const override {
    const physx::PxTransform pose = actor_->getGlobalPose();
    return {fromPhysX(pose.p), {pose.q.x, pose.q.y, pose.q.z, pose.q.w}};
  }
  [[nodiscard]] Vec3 linearVelocity() const override {
    return frozen_ ? Vec3{} : fromPhysX(actor_->getLinearVelocity());
  }
  [[nodiscard]] Vec3 angularVelocity() const override {
    return frozen_ ? Vec3{} : fromPhysX(actor_->getAngularVelocity());
  }

  void setPose(const Pose& pose) override { actor_->setGlobalPose(toPhysX(pose)); }
  void setVelocity(const Vec3& linear, const Vec3& angular) override {
    if (frozen_) return;
    actor_->setLinearVelocity(toPhysX(linear));
    actor_->setAngularVelocity(toPhysX(angular));
  }

  [[nodiscard]] bool asleep() const override { return frozen_ || actor_->isSleeping(); }
  [[nodiscard]] bool frozen() const override { return frozen_; }
  void freeze() override {
    frozen_ = true;
    actor_->setRigidBodyFlag(physx::PxRigidBodyFlag::eENABLE_CCD, false);
    actor_->setRigidBodyFlag(physx::PxRigidBodyFlag::eKINEMATIC, true);
  }

  void wake() {
    if (!frozen_) actor_->wakeUp();
  }

 private:
  Shape shape_;
  physx::PxScene& scene_;
  Released<physx::PxRigidDynamic> actor_;
  bool frozen_ = false;
};

class PhysXEngine final : public PhysicsEngine {
 public:
  explicit PhysXEngine(const PhysicsSettings& settings)
      : settings_(settings), dispatcher_((factory(), physx::PxDefaultCpuDispatcherCreate(0))) {
    physx::PxSceneDesc description(factory().getTolerancesScale());
    description.cpuDispatcher = dispatcher_.get();
    description.filterShader = whetherToCollide;
    description.bounceThresholdVelocity = kBounceSpeed;
    description.solverType = physx::PxSolverType::eTGS;
    description.flags |= physx::PxSceneFlag::eENABLE_ENHANCED_DETERMINISM;
    description.flags |= physx::PxSceneFlag::eENABLE_CCD;
    description.ccdThreshold = kSweptWay;
    scene_.reset(factory().createScene(description));
    if (!scene_) throw UnsupportedError("PhysX: creates no scene");
    const auto friction = static_cast<float>(settings.friction);
    material_.reset(
        factory().createMaterial(friction, friction, static_cast<float>(settings.restitution)));
  }

  void setLayers(const LayerMatrix& layers) override { layers_ = layers; }

  PhysicsBody& addBody(const BodyDescription& description) override {
    return bodies_.add(description, settings_, *scene_, *material_,
                       layers_.rows()[description.layer]);
  }
  void removeBody(PhysicsBody& body) override { bodies_.remove(static_cast<PhysXBody&>(body)); }

  void addWall(const HalfSpace& wall) override {
    // A box, as planes are left out of continuous detection: solid as far as this from the point
    // of the wall that is nearest to the origin.
    const float extent = 1000 + 10 * std::abs(wall.offset);
    const physx::PxPlane plane(toPhysX(wall.normal), -wall.offset);
    physx::PxTransform pose = physx::PxTransformFromPlaneEquation(plane);  // x along the normal
    pose.p -= toPhysX(wall.normal) * extent;
    physx::PxRigidStatic* const actor = factory().createRigidStatic(pose);
    physx::PxShape* const shape = physx::PxRigidActorExt::createExclusiveShape(
        *actor, physx::PxBoxGeometry(extent, extent, extent), *material_);
    shape->setContactOffset(kContactOffset);
    shape->setSimulationFilterData(Layers(0, 0, 1, 0));
    scene_->addActor(*actor);
    walls_.emplace_back(actor);
  }

  void setGravity(const Vec3& gravity) override {
    if (gravity == gravity_) return;
    gravity_ = gravity;
    scene_->setGravity(toPhysX(gravity));
    bodies_.each([](PhysXBody& body) { body.wake(); });
  }
  [[nodiscard]] Vec3 gravity() const override { return gravity_; }

  void step() override {
    const double time = settings_.time_step / static_cast<double>(settings_.substeps);
    for (std::int64_t i = 0; i < settings_.substeps; ++i) {
      scene_->simulate(static_cast<float>(time));
      scene_->fetchResults(/*block=*/true);
      PhysXErrors::instance().check();
    }
  }

  [[nodiscard]] bool allAsleep() const override {
    return bodies_.all([](const PhysXBody& body) { return body.asleep(); });
  }

 private:
  PhysicsSettings settings_;
  Vec3 gravity_{};
  LayerMatrix layers_ = LayerMatrix::all();
  Released<physx::PxDefaultCpuDispatcher> dispatcher_;
  Released<physx::PxScene> scene_;
  Released<physx::PxMaterial> material_;
  std::vector<Released<physx::PxRigidStatic>> walls_;
  BodyPool<PhysXBody> bodies_;
};

std::vector<EngineEntry> engines() {
  return {{.listing = {.id = "physx", .summary = "PhysX's rigid bodies"},
           .create = [](const PhysicsSettings& settings) -> std::unique_ptr<PhysicsEngine> {
             return std::make_unique<PhysXEngine>(settings);
           }}};
}

}  // namespace
}  // namespace broadmark::scenes::physx_engine

BROADMARK_ENGINE_PLUGIN(broadmark::scenes::physx_engine::engines);
