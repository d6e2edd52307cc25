// Rigid bodies by Jolt Physics: quad trees, GJK and EPA, sequential impulses with warm starting,
// sleeping islands.
//
// Single-threaded, because the generator bakes a scene per core. Jolt is deterministic
// (mDeterministicSimulation): the same calls give bit-identical results.
//
// Jolt requires the maximum numbers of bodies and contacts in advance; they are parameters of this
// engine. Exceeding them is an error, so no contact is dropped silently.

#include "broadmark/scenes/physics_engine.h"

#include "broadmark/scenes/engine_plugin.h"
#include "jolt/library.h"
// Jolt's own headers after the one above.
#include <Jolt/Core/JobSystemSingleThreaded.h>
#include <Jolt/Core/TempAllocator.h>
#include <Jolt/Physics/Body/BodyCreationSettings.h>
#include <Jolt/Physics/Collision/Shape/BoxShape.h>
#include <Jolt/Physics/Collision/Shape/PlaneShape.h>
#include <Jolt/Physics/Collision/Shape/SphereShape.h>
#include <Jolt/Physics/PhysicsSystem.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "broadmark/error.h"
#include "broadmark/scenes/body_pool.h"
#include "damping.h"

namespace broadmark::scenes::jolt_engine {
namespace {

JPH::Vec3 toJolt(const Vec3& v) { return {v[0], v[1], v[2]}; }
JPH::Quat toJolt(const std::array<float, 4>& q) { return {q[0], q[1], q[2], q[3]}; }
Vec3 fromJolt(JPH::Vec3Arg v) { return {v.GetX(), v.GetY(), v.GetZ()}; }

/// Our layers and a layer for the walls; two broad-phase layers, for walls and for bodies.
class Layers final : public JPH::BroadPhaseLayerInterface,
                     public JPH::ObjectVsBroadPhaseLayerFilter,
                     public JPH::ObjectLayerPairFilter {
 public:
  static constexpr JPH::ObjectLayer kWalls = LayerMatrix::kLayers;

  void set(const LayerMatrix& matrix) { matrix_ = matrix; }

  JPH::uint GetNumBroadPhaseLayers() const override { return 2; }
  JPH::BroadPhaseLayer GetBroadPhaseLayer(JPH::ObjectLayer layer) const override {
    return JPH::BroadPhaseLayer(layer == kWalls ? 0 : 1);
  }
#if defined(JPH_EXTERNAL_PROFILE) || defined(JPH_PROFILE_ENABLED)
  const char* GetBroadPhaseLayerName(JPH::BroadPhaseLayer) const override { return "layer"; }
#endif
  bool ShouldCollide(JPH::ObjectLayer, JPH::BroadPhaseLayer) const override { return true; }
  bool ShouldCollide(JPH::ObjectLayer a, JPH::ObjectLayer b) const override {
    return a == kWalls || b == kWalls || matrix_.collide(a, b);
  }

 private:
  LayerMatrix matrix_ = LayerMatrix::all();
};

JPH::Ref<JPH::Shape> shapeOf(const BoxShape& box) {
  const Vec3& half = box.half_extents;
  // Jolt recommends a convex radius; it is limited for thin boxes.
  const float radius =
      std::min(JPH::cDefaultConvexRadius, std::min({half[0], half[1], half[2]}) / 4);
  return new JPH::BoxShape(toJolt(half), radius);
}
JPH::Ref<JPH::Shape> shapeOf(const SphereShape& sphere) {
  return new JPH::SphereShape(sphere.radius);
}

class JoltBody : public PhysicsBody {
 public:
  /// `interface` is not owned.
  JoltBody(const BodyDescription& description, const PhysicsSettings& settings,
           JPH::BodyInterface& interface)
      : shape_(description.shape), interface_(interface) {
    const auto shape = std::visit([](const auto& kind) { return shapeOf(kind); }, shape_);
    JPH::BodyCreationSettings body_settings(
        shape, toJolt(description.pose.position), toJolt(description.pose.rotation).Normalized(),
        JPH::EMotionType::Dynamic, static_cast<JPH::ObjectLayer>(description.layer));
    body_settings.mLinearVelocity = toJolt(description.linear_velocity);
    body_settings.mAngularVelocity = toJolt(description.angular_velocity);
    body_settings.mFriction = static_cast<float>(settings.friction);
    body_settings.mRestitution = static_cast<float>(settings.restitution);
    body_settings.mLinearDamping = dampingFactor(settings.linear_damping);
    body_settings.mAngularDamping = dampingFactor(settings.angular_damping);
    body_settings.mMotionQuality = JPH::EMotionQuality::LinearCast;
    body_settings.mMaxLinearVelocity = 1e6F;  // no limit
    body_settings.mMaxAngularVelocity = static_cast<float>(settings.max_angular_speed);
    body_settings.mOverrideMassProperties = JPH::EOverrideMassProperties::CalculateInertia;
    body_settings.mMassPropertiesOverride.mMass = static_cast<float>(description.mass);
    body_ = interface.CreateBody(body_settings);
    if (body_ == nullptr) {
      throw InputError("engine 'jolt': more bodies than its parameter max_bodies allows");
    }
    interface.AddBody(id(), JPH::EActivation::Activate);
  }
  JoltBody(const JoltBody&) = delete;
  JoltBody& operator=(const JoltBody&) = delete;
  ~JoltBody() override {
    interface_.RemoveBody(id());
    interface_.DestroyBody(id());
  }

  [[nodiscard]] const Shape& shape() const override { return shape_; }

  [[nodiscard]] Pose pose() const override {
    const JPH::Quat q = body_->GetRotation();
    return {fromJolt(JPH::Vec3(body_->GetPosition())), {q.GetX(), q.GetY(), q.GetZ(), q.GetW()}};
  }
  [[nodiscard]] Vec3 linearVelocity() const override {
    return frozen() ? Vec3{} : fromJolt(body_->GetLinearVelocity());
  }
  [[nodiscard]] Vec3 angularVelocity() const override {
    return frozen() ? Vec3{} : fromJolt(body_->GetAngularVelocity());
  }

  void setPose(const Pose& pose) override {
    interface_.SetPositionAndRotation(id(), toJolt(pose.position),
                                      toJolt(pose.rotation).Normalized(),
                                      JPH::EActivation::Activate);
  }
  void setVelocity(const Vec3& linear, const Vec3& angular) override {
    if (frozen()) return;
    interface_.SetLinearAndAngularVelocity(id(), toJolt(linear), toJolt(angular));
    wake();
  }

  [[nodiscard]] bool asleep() const override { return !body_->IsActive(); }
  [[nodiscard]] bool frozen() const override { return body_->IsStatic(); }
  void freeze() override {
    interface_.SetMotionType(id(), JPH::EMotionType::Static, JPH::EActivation::DontActivate);
  }

  void wake() {
    if (!frozen()) interface_.ActivateBody(id());
  }
  /// Wakes the bodies nearby.
  void wakeNeighbours() {
    constexpr float kMargin = 0.1F;
    JPH::AABox bounds = body_->GetWorldSpaceBounds();
    bounds.ExpandBy(JPH::Vec3::sReplicate(kMargin));
    interface_.ActivateBodiesInAABox(bounds, {}, {});
  }

 private:
  [[nodiscard]] const JPH::BodyID& id() const { return body_->GetID(); }

  Shape shape_;
  JPH::BodyInterface& interface_;
  JPH::Body* body_ = nullptr;  ///< owned by interface_
};

class JoltEngine final : public PhysicsEngine {
 public:
  explicit JoltEngine(const PhysicsSettings& settings) : settings_(settings) {}
  JoltEngine(const JoltEngine&) = delete;
  JoltEngine& operator=(const JoltEngine&) = delete;
  ~JoltEngine() override {
    bodies_.reset();
    for (const JPH::BodyID& wall : walls_) {
      system_->GetBodyInterfaceNoLock().RemoveBody(wall);
      system_->GetBodyInterfaceNoLock().DestroyBody(wall);
    }
  }

  void visitParameters(const ParameterVisitor& visit) override {
    visit({"max_bodies", "maximum number of bodies, including walls", &max_bodies_, 16,
           JPH::BodyID::cMaxBodyIndex});
    visit({"max_contacts", "maximum number of pairs of nearby bodies", &max_contacts_, 16,
           100'000'000});
  }

  void setLayers(const LayerMatrix& layers) override { layers_.set(layers); }

  PhysicsBody& addBody(const BodyDescription& description) override {
    createSystem();
    return bodies_->add(description, settings_, system_->GetBodyInterfaceNoLock());
  }

  void removeBody(PhysicsBody& body) override {
    auto& jolt_body = static_cast<JoltBody&>(body);
    jolt_body.wakeNeighbours();
    bodies_->remove(jolt_body);
  }

  void addWall(const HalfSpace& wall) override {
    createSystem();
    // The wall extends this far from its point nearest to the origin.
    const float extent = 1000 + 10 * std::abs(wall.offset);
    JPH::BodyCreationSettings wall_settings(
        new JPH::PlaneShape(JPH::Plane(toJolt(wall.normal), -wall.offset), nullptr, extent),
        JPH::RVec3::sZero(), JPH::Quat::sIdentity(), JPH::EMotionType::Static, Layers::kWalls);
    wall_settings.mFriction = static_cast<float>(settings_.friction);
    wall_settings.mRestitution = static_cast<float>(settings_.restitution);
    walls_.push_back(system_->GetBodyInterfaceNoLock().CreateAndAddBody(
        wall_settings, JPH::EActivation::DontActivate));
  }

  void setGravity(const Vec3& gravity) override {
    if (gravity == gravity_) return;
    gravity_ = gravity;
    createSystem();
    system_->SetGravity(toJolt(gravity));
    bodies_->each([](JoltBody& body) { body.wake(); });
  }
  [[nodiscard]] Vec3 gravity() const override { return gravity_; }

  void step() override {
    createSystem();
    if (!std::exchange(stepped_, true)) system_->OptimizeBroadPhase();
    const JPH::EPhysicsUpdateError error =
        system_->Update(static_cast<float>(settings_.time_step),
                        static_cast<int>(settings_.substeps), &memory_, &jobs_);
    if (error != JPH::EPhysicsUpdateError::None) {
      throw InputError("engine 'jolt': more contacts than its parameter max_contacts allows");
    }
  }

  [[nodiscard]] bool allAsleep() const override {
    return !system_ || system_->GetNumActiveBodies(JPH::EBodyType::RigidBody) == 0;
  }

 private:
  /// Creates Jolt's world on first use, when the parameters are known.
  void createSystem() {
    if (system_) return;
    system_.emplace();
    const auto contacts = static_cast<JPH::uint>(max_contacts_);
    system_->Init(static_cast<JPH::uint>(max_bodies_), 0, contacts, contacts, layers_, layers_,
                  layers_);
    JPH::PhysicsSettings settings = system_->GetPhysicsSettings();
    // Friction requires at least two iterations.
    settings.mNumVelocitySteps =
        static_cast<JPH::uint>(std::max<std::int64_t>(settings_.solver_iterations, 2));
    // Continuous detection only for bodies that would penetrate a wall deeply in a step: the solver
    // separates bodies that start overlapping.
    settings.mLinearCastThreshold = 0.2F;
    settings.mLinearCastMaxPenetration = 0.02F;
    // The speed of a body that moves without rotation.
    settings.mPointVelocitySleepThreshold =
        static_cast<float>(std::max(std::sqrt(2 * settings_.sleep_threshold), 1e-6));
    system_->SetPhysicsSettings(settings);
    system_->SetGravity(JPH::Vec3::sZero());
    bodies_.emplace();
  }

  JoltLibrary library_;
  PhysicsSettings settings_;
  std::int64_t max_bodies_ = 65'536;
  std::int64_t max_contacts_ = 1'048'576;
  Vec3 gravity_{};
  Layers layers_;
  JPH::TempAllocatorMalloc memory_;
  JPH::JobSystemSingleThreaded jobs_{JPH::cMaxPhysicsJobs};
  std::optional<JPH::PhysicsSystem> system_;
  std::vector<JPH::BodyID> walls_;
  std::optional<BodyPool<JoltBody>> bodies_;
  bool stepped_ = false;
};

std::vector<EngineEntry> engines() {
  return {{.listing = {.id = "jolt", .summary = "Jolt Physics' rigid bodies"},
           .create = [](const PhysicsSettings& settings) -> std::unique_ptr<PhysicsEngine> {
             return std::make_unique<JoltEngine>(settings);
           }}};
}

}  // namespace
}  // namespace broadmark::scenes::jolt_engine

BROADMARK_ENGINE_PLUGIN(broadmark::scenes::jolt_engine::engines);
