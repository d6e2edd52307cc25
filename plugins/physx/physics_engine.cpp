// Rigid bodies by PhysX: persistent contact manifolds, a solver over islands, sleeping by energy.
//
// The temporal Gauss-Seidel solver (TGS), which PhysX recommends for differing masses and sizes,
// separates bodies that start overlapping; speculative contacts did not.
//
// Single-threaded, because the generator bakes a scene per core. With enhanced determinism, the
// same calls give bit-identical results.

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

/// The minimum speed of an impact that bounces, in units per second.
constexpr float kMinBounceSpeed = 0.1F;
/// The maximum speed at which overlapping bodies are separated, in units per second, so that bodies
/// that start overlapping do not explode.
constexpr float kMaxSeparationSpeed = 5;

/// The distance below which PhysX generates contacts, so that bodies of normal speed stop at a wall
/// and not inside it.
constexpr float kContactOffset = 0.1F;
/// The relative motion per substep above which continuous detection is used, so that bodies do not
/// tunnel through walls. PhysX's default is based on the shapes' sizes, which are huge for walls.
constexpr float kCcdThreshold = 0.4F;

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

/// A body's layer, the mask of layers it collides with, and 0; 0, 0 and 1 for a wall.
using Layers = physx::PxFilterData;

physx::PxFilterFlags filterCollision(physx::PxFilterObjectAttributes, Layers a,
                                     physx::PxFilterObjectAttributes, Layers b,
                                     physx::PxPairFlags& pair, const void*, physx::PxU32) {
  pair = physx::PxPairFlag::eCONTACT_DEFAULT | physx::PxPairFlag::eDETECT_CCD_CONTACT;
  const bool is_wall = (a.word2 | b.word2) != 0;
  return is_wall || (a.word1 & b.word0) != 0 ? physx::PxFilterFlag::eDEFAULT
                                             : physx::PxFilterFlag::eSUPPRESS;
}

class PhysXBody : public PhysicsBody {
 public:
  /// `scene` and `material` are not owned. `mask`: the layers that the body collides with.
  PhysXBody(const BodyDescription& description, const PhysicsSettings& settings,
            physx::PxScene& scene, physx::PxMaterial& material, std::uint32_t mask)
      : shape_(description.shape), scene_(scene) {
    actor_.reset(physXFactory().createRigidDynamic(toPhysX(description.pose)));
    physx::PxShape* const shape = std::visit(
        [&](const auto& kind) {
          return physx::PxRigidActorExt::createExclusiveShape(*actor_, geometryOf(kind), material);
        },
        shape_);
    shape->setContactOffset(kContactOffset);
    shape->setSimulationFilterData(Layers(1U << description.layer, mask, 0, 0));
    physx::PxRigidBodyExt::setMassAndUpdateInertia(*actor_, static_cast<float>(description.mass));
    actor_->setLinearDamping(dampingFactor(settings.linear_damping));
    actor_->setAngularDamping(dampingFactor(settings.angular_damping));
    actor_->setMaxAngularVelocity(static_cast<float>(settings.max_angular_speed));
    actor_->setMaxDepenetrationVelocity(kMaxSeparationSpeed);
    actor_->setSleepThreshold(static_cast<float>(settings.sleep_threshold));
    // PhysX's maximum is 255.
    actor_->setSolverIterationCounts(
        static_cast<physx::PxU32>(std::min<std::int64_t>(settings.solver_iterations, 255)));
    actor_->setRigidBodyFlag(physx::PxRigidBodyFlag::eENABLE_CCD, true);
    scene_.addActor(*actor_);
    actor_->setLinearVelocity(toPhysX(description.linear_velocity));
    actor_->setAngularVelocity(toPhysX(description.angular_velocity));
  }
  PhysXBody(const PhysXBody&) = delete;
  PhysXBody& operator=(const PhysXBody&) = delete;
  ~PhysXBody() override { scene_.removeActor(*actor_); }  // wakes the touching bodies

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
  PhysXPtr<physx::PxRigidDynamic> actor_;
  bool frozen_ = false;
};

class PhysXEngine final : public PhysicsEngine {
 public:
  explicit PhysXEngine(const PhysicsSettings& settings)
      : settings_(settings), dispatcher_((physXFactory(), physx::PxDefaultCpuDispatcherCreate(0))) {
    physx::PxSceneDesc description(physXFactory().getTolerancesScale());
    description.cpuDispatcher = dispatcher_.get();
    description.filterShader = filterCollision;
    description.bounceThresholdVelocity = kMinBounceSpeed;
    description.solverType = physx::PxSolverType::eTGS;
    description.flags |= physx::PxSceneFlag::eENABLE_ENHANCED_DETERMINISM;
    description.flags |= physx::PxSceneFlag::eENABLE_CCD;
    description.ccdThreshold = kCcdThreshold;
    scene_.reset(physXFactory().createScene(description));
    if (!scene_) throw UnsupportedError("PhysX: cannot create a scene");
    const auto friction = static_cast<float>(settings.friction);
    material_.reset(physXFactory().createMaterial(friction, friction,
                                                  static_cast<float>(settings.restitution)));
  }

  void setLayers(const LayerMatrix& layers) override { layers_ = layers; }

  PhysicsBody& addBody(const BodyDescription& description) override {
    return bodies_.add(description, settings_, *scene_, *material_,
                       layers_.rows()[description.layer]);
  }
  void removeBody(PhysicsBody& body) override { bodies_.remove(static_cast<PhysXBody&>(body)); }

  void addWall(const HalfSpace& wall) override {
    // A box, because continuous detection ignores planes. It extends this far from the point of the
    // wall nearest to the origin.
    const float extent = 1000 + 10 * std::abs(wall.offset);
    const physx::PxPlane plane(toPhysX(wall.normal), -wall.offset);
    physx::PxTransform pose = physx::PxTransformFromPlaneEquation(plane);  // x along the normal
    pose.p -= toPhysX(wall.normal) * extent;
    physx::PxRigidStatic* const actor = physXFactory().createRigidStatic(pose);
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
  PhysXPtr<physx::PxDefaultCpuDispatcher> dispatcher_;
  PhysXPtr<physx::PxScene> scene_;
  PhysXPtr<physx::PxMaterial> material_;
  std::vector<PhysXPtr<physx::PxRigidStatic>> walls_;
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
