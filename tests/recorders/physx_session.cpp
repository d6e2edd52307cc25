// PhysX: cubes, some with a second shape, and a kinematic slab.

#include "integrations/physx.h"

#include <cmath>

#include "recorders/session.h"

namespace {

using namespace physx;

constexpr float kSide = 27;

/// PhysX' world, with its bodies.
class Cubes {
 public:
  explicit Cubes(PxSimulationFilterCallback& callback) {
    PxSceneDesc settings(physics_->getTolerancesScale());
    settings.gravity = PxVec3(0, -9.8F, 0);
    settings.cpuDispatcher = dispatcher_;
    settings.filterShader = BroadmarkPhysx::shader;
    settings.filterCallback = &callback;
    scene_ = physics_->createScene(settings);
    for (int axis = 0; axis < 3; ++axis) {
      for (const float sign : {-1.0F, 1.0F}) {
        PxVec3 half(kSide);
        PxVec3 at(0);
        half[static_cast<PxU32>(axis)] = 1;
        at[static_cast<PxU32>(axis)] = sign * (kSide / 2 + 1);
        scene_->addActor(
            *PxCreateStatic(*physics_, PxTransform(at), PxBoxGeometry(half), *material_));
      }
    }
    slab_ = PxCreateKinematic(*physics_, PxTransform(PxVec3(0)), PxBoxGeometry(3, 0.5F, 3),
                              *material_, 1);
    scene_->addActor(*slab_);
    for (int i = 0; i < kCubes; ++i) add();
  }
  ~Cubes() {
    scene_->release();
    dispatcher_->release();
    physics_->release();
    foundation_->release();
  }
  Cubes(const Cubes&) = delete;
  Cubes& operator=(const Cubes&) = delete;

  void add() {
    const float reach = kSide / 2 - 1;
    const auto coordinate = [&] { return (2 * uniform(&random_) - 1) * reach; };
    const PxVec3 at(coordinate(), coordinate(), coordinate());
    PxRigidDynamic* const body =
        PxCreateDynamic(*physics_, PxTransform(at), PxBoxGeometry(0.5F, 0.5F, 0.5F), *material_, 1);
    if (uniform(&random_) < 0.1F) {
      PxRigidActorExt::createExclusiveShape(*body, PxSphereGeometry(0.6F), *material_);
    }
    scene_->addActor(*body);
    bodies_.push_back(body);
  }
  void replaceSome() {
    for (int i = 0; i < kCubes / 100; ++i) {
      const auto leaving =
          static_cast<std::size_t>(uniform(&random_) * static_cast<float>(bodies_.size()));
      bodies_[leaving]->release();
      bodies_[leaving] = bodies_.back();
      bodies_.pop_back();
      add();
    }
  }
  void setGravity(const PxVec3& gravity) {
    scene_->setGravity(gravity);
    for (PxRigidDynamic* const body : bodies_) body->wakeUp();
  }
  void moveSlab(float height) { slab_->setKinematicTarget(PxTransform(PxVec3(0, height, 0))); }
  void step() {
    scene_->simulate(1 / 60.0F);
    scene_->fetchResults(true);
  }
  PxScene& scene() { return *scene_; }

 private:
  PxDefaultAllocator allocator_;
  PxDefaultErrorCallback errors_;
  PxFoundation* foundation_ = PxCreateFoundation(PX_PHYSICS_VERSION, allocator_, errors_);
  PxPhysics* physics_ = PxCreatePhysics(PX_PHYSICS_VERSION, *foundation_, PxTolerancesScale());
  PxDefaultCpuDispatcher* dispatcher_ = PxDefaultCpuDispatcherCreate(2);
  PxMaterial* material_ = physics_->createMaterial(0.5F, 0.5F, 0.1F);
  PxScene* scene_ = nullptr;
  PxRigidDynamic* slab_ = nullptr;
  std::vector<PxRigidDynamic*> bodies_;
  unsigned long long random_ = 1;
};

}  // namespace

const char* const kAuditMargin = "1e-6";

int recordSession(const char* name, World world) {
  BroadmarkPhysx session;
  session.begin(name, 2 * kCubes);
  Cubes bodies(session);
  for (int frame = 0; frame < kFrames; ++frame) {
    const float angle = 0.05F * static_cast<float>(frame);
    if (world == kTurning) bodies.setGravity(PxVec3(std::cos(angle), std::sin(angle), 0) * 30);
    if (world == kChurning) bodies.replaceSome();
    bodies.moveSlab(5 * std::sin(2 * angle));
    session.boxes(bodies.scene());
    bodies.step();
    session.pairs();
  }
  return session.end() ? 1 : 0;
}
