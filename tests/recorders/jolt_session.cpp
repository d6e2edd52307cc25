// Jolt: cubes in three object layers, one of which does not collide with itself.

#include "integrations/jolt.h"
// Jolt's headers must follow the header above.
#include <Jolt/Core/JobSystemThreadPool.h>
#include <Jolt/Core/TempAllocator.h>
#include <Jolt/Physics/Body/BodyCreationSettings.h>
#include <Jolt/Physics/Collision/Shape/BoxShape.h>

#include <cmath>

#include "jolt/library.h"
#include "recorders/session.h"

namespace {

enum Layer : JPH::ObjectLayer { walls, cubes, ghosts };

class Layers final : public JPH::BroadPhaseLayerInterface,
                     public JPH::ObjectVsBroadPhaseLayerFilter,
                     public JPH::ObjectLayerPairFilter {
 public:
  JPH::uint GetNumBroadPhaseLayers() const override { return 2; }
  JPH::BroadPhaseLayer GetBroadPhaseLayer(JPH::ObjectLayer layer) const override {
    return JPH::BroadPhaseLayer(layer == walls ? 0 : 1);
  }
#if defined(JPH_EXTERNAL_PROFILE) || defined(JPH_PROFILE_ENABLED)
  const char* GetBroadPhaseLayerName(JPH::BroadPhaseLayer) const override { return "layer"; }
#endif
  bool ShouldCollide(JPH::ObjectLayer layer, JPH::BroadPhaseLayer other) const override {
    return layer != walls || other == JPH::BroadPhaseLayer(1);
  }
  bool ShouldCollide(JPH::ObjectLayer a, JPH::ObjectLayer b) const override {
    return a != b || a == cubes;
  }
};

/// Jolt's world, with its bodies.
class Cubes {
 public:
  Cubes() {
    system_.Init(2 * kCubes, 0, 65536, 40000, layers_, layers_, layers_);
    for (int axis = 0; axis < 3; ++axis) {
      for (const float sign : {-1.0F, 1.0F}) {
        JPH::Vec3 half = JPH::Vec3::sReplicate(kSide);
        JPH::Vec3 at = JPH::Vec3::sZero();
        half.SetComponent(static_cast<JPH::uint>(axis), 1);
        at.SetComponent(static_cast<JPH::uint>(axis), sign * (kSide / 2 + 1));
        bodies().CreateAndAddBody({new JPH::BoxShape(half), JPH::RVec3(at), JPH::Quat::sIdentity(),
                                   JPH::EMotionType::Static, walls},
                                  JPH::EActivation::DontActivate);
      }
    }
    for (int i = 0; i < kCubes; ++i) add();
    system_.OptimizeBroadPhase();
  }

  void add() {
    const float reach = kSide / 2 - 1;
    const auto coordinate = [&] { return (2 * uniform(&random_) - 1) * reach; };
    const JPH::Vec3 at(coordinate(), coordinate(), coordinate());
    const Layer layer = uniform(&random_) < 0.1F ? ghosts : cubes;
    ids_.push_back(bodies().CreateAndAddBody(
        {shape_, JPH::RVec3(at), JPH::Quat::sIdentity(), JPH::EMotionType::Dynamic, layer},
        JPH::EActivation::Activate));
  }
  void replaceSome() {
    for (int i = 0; i < kCubes / 100; ++i) {
      const auto leaving =
          static_cast<std::size_t>(uniform(&random_) * static_cast<float>(ids_.size()));
      bodies().RemoveBody(ids_[leaving]);
      bodies().DestroyBody(ids_[leaving]);
      ids_[leaving] = ids_.back();
      ids_.pop_back();
      add();
    }
  }
  void setGravity(const JPH::Vec3& gravity) {
    system_.SetGravity(gravity);
    for (const JPH::BodyID id : ids_) bodies().ActivateBody(id);
  }
  const JPH::PhysicsSystem& step() {
    system_.Update(1 / 60.0F, 1, &memory_, &jobs_);
    return system_;
  }

 private:
  static constexpr float kSide = 27;

  JPH::BodyInterface& bodies() { return system_.GetBodyInterface(); }

  broadmark::JoltLibrary library_;
  Layers layers_;
  JPH::TempAllocatorImpl memory_{64 << 20};
  JPH::JobSystemThreadPool jobs_{JPH::cMaxPhysicsJobs, JPH::cMaxPhysicsBarriers, 2};
  JPH::Ref<JPH::Shape> shape_ = new JPH::BoxShape(JPH::Vec3::sReplicate(0.5F));
  JPH::PhysicsSystem system_;
  std::vector<JPH::BodyID> ids_;
  unsigned long long random_ = 1;
};

}  // namespace

const char* const kAuditMargin = "0.01";

int recordSession(const char* name, World world) {
  Cubes bodies;
  BroadmarkJolt session;
  session.begin(name, kCubes + 50);
  for (int frame = 0; frame < kFrames; ++frame) {
    const float angle = 0.05F * static_cast<float>(frame);
    if (world == kTurning) bodies.setGravity(30 * JPH::Vec3(std::cos(angle), std::sin(angle), 0));
    if (world == kChurning) bodies.replaceSome();
    session.record(bodies.step());
  }
  return session.end() ? 1 : 0;
}
