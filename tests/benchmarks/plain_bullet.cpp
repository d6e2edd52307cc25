// Measures what the Bullet engine costs beside a plain loop over Bullet's world with its defaults:
// the same bodies, walls, time step and iterations, and what Brownian and Gravity do in each frame.
// The two take turns frame by frame, so that whatever else slows the machine slows both. Exit
// status 1 where the engine is the slower one.
//
//   plain_bullet [OBJECTS [FRAMES]]

#include <btBulletDynamicsCommon.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "scenes/scene.h"

namespace {

using namespace broadmark;
using namespace broadmark::scenes;

btVector3 toBullet(const Vec3& v) { return {v[0], v[1], v[2]}; }

class PlainBody final : public PhysicsBody {
 public:
  PlainBody(const BodyDescription& description,
            const btRigidBody::btRigidBodyConstructionInfo& info)
      : shape_(description.shape), body(info) {
    body.setLinearVelocity(toBullet(description.linear_velocity));
  }

  [[nodiscard]] const Shape& shape() const override { return shape_; }
  [[nodiscard]] Pose pose() const override {
    const btVector3& p = body.getWorldTransform().getOrigin();
    const btQuaternion q = body.getWorldTransform().getRotation();
    return {{p.x(), p.y(), p.z()}, {q.x(), q.y(), q.z(), q.w()}};
  }
  [[nodiscard]] Vec3 linearVelocity() const override {
    const btVector3& v = body.getLinearVelocity();
    return {v.x(), v.y(), v.z()};
  }
  [[nodiscard]] Vec3 angularVelocity() const override {
    const btVector3& v = body.getAngularVelocity();
    return {v.x(), v.y(), v.z()};
  }
  void setPose(const Pose&) override {}  // neither scene does
  void setVelocity(const Vec3& linear, const Vec3& angular) override {
    body.setLinearVelocity(toBullet(linear));
    body.setAngularVelocity(toBullet(angular));
    body.activate();
  }
  [[nodiscard]] bool asleep() const override { return !body.isActive(); }
  [[nodiscard]] bool frozen() const override { return false; }
  void freeze() override {}

 private:
  Shape shape_;

 public:
  btRigidBody body;
};

/// Bullet as its manual shows it.
class PlainBullet final : public PhysicsEngine {
 public:
  explicit PlainBullet(const PhysicsSettings& settings) : settings_(settings) {
    world_.setGravity(btVector3(0, 0, 0));
    world_.getSolverInfo().m_numIterations = static_cast<int>(settings.solver_iterations);
  }
  ~PlainBullet() override {
    for (PlainBody& body : bodies_) world_.removeRigidBody(&body.body);
    for (btRigidBody& wall : walls_) world_.removeRigidBody(&wall);
  }
  PlainBullet(const PlainBullet&) = delete;
  PlainBullet& operator=(const PlainBullet&) = delete;

  PhysicsBody& addBody(const BodyDescription& description) override {
    if (!shape_) {
      const auto& box = std::get<BoxShape>(description.shape);
      shape_ = std::make_unique<btBoxShape>(toBullet(box.half_extents));
    }
    btVector3 inertia;
    shape_->calculateLocalInertia(1, inertia);
    btRigidBody::btRigidBodyConstructionInfo info(1, nullptr, shape_.get(), inertia);
    info.m_startWorldTransform.setIdentity();
    info.m_startWorldTransform.setOrigin(toBullet(description.pose.position));
    info.m_friction = static_cast<btScalar>(std::sqrt(settings_.friction));
    info.m_angularDamping = static_cast<btScalar>(settings_.angular_damping);
    PlainBody& body = bodies_.emplace_back(description, info);
    world_.addRigidBody(&body.body);
    return body;
  }

  void addWall(const HalfSpace& wall) override {
    auto& shape = wall_shapes_.emplace_back(toBullet(wall.normal), wall.offset);
    btRigidBody::btRigidBodyConstructionInfo info(0, nullptr, &shape);
    info.m_friction = static_cast<btScalar>(std::sqrt(settings_.friction));
    world_.addRigidBody(&walls_.emplace_back(info));
  }

  void setGravity(const Vec3& gravity) override {
    for (PlainBody& body : bodies_) body.body.activate();
    world_.setGravity(toBullet(gravity));
  }

  void step() override {
    const auto substeps = static_cast<int>(settings_.substeps);
    const auto time = static_cast<btScalar>(settings_.time_step);
    world_.stepSimulation(time, substeps, time / static_cast<btScalar>(substeps));
  }

  [[nodiscard]] bool allAsleep() const override { return false; }

 private:
  PhysicsSettings settings_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broad_phase_;
  btSequentialImpulseConstraintSolver solver_;
  std::unique_ptr<btBoxShape> shape_;
  std::deque<btStaticPlaneShape> wall_shapes_;
  std::deque<btRigidBody> walls_;
  std::deque<PlainBody> bodies_;
  btDiscreteDynamicsWorld world_{&dispatcher_, &broad_phase_, &solver_, &configuration_};
};

/// One engine at work on a scene.
class Contestant {
 public:
  Contestant(std::string name, const std::string& scene, std::int64_t objects,
             const auto& make_engine)
      : name_(std::move(name)) {
    for (const SceneEntry& entry : sceneEntries()) {
      if (entry.listing.id == scene) scene_ = entry.create();
    }
    scene_->setDefaults(settings_);
    settings_.objects = objects;
    engine_ = make_engine(settings_.physics);
    for (int axis = 0; axis < 3; ++axis) {
      for (const float sign : {1.0F, -1.0F}) {
        HalfSpace wall{.offset = static_cast<float>(-settings_.side() / 2)};
        wall.normal[axis] = sign;
        engine_->addWall(wall);
      }
    }
    const ObjectType cubes = objectTypes().front();
    for (std::int64_t i = 0; i < objects; ++i) {
      bodies_.push_back(
          &engine_->addBody(scene_->body(static_cast<std::size_t>(i), settings_, cubes, random_)));
    }
    Stage stage = makeStage();
    scene_->start(stage);
  }

  void advance(std::uint32_t frame) {
    const auto start = std::chrono::steady_clock::now();
    engine_->step();
    seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    Stage stage = makeStage();
    scene_->act(stage, frame);
  }

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] double seconds() const { return seconds_; }

 private:
  Stage makeStage() { return {settings_, *engine_, bodies_, random_}; }

  std::string name_;
  std::unique_ptr<Scene> scene_;
  Settings settings_;
  Random random_{1};
  std::unique_ptr<PhysicsEngine> engine_;
  std::vector<PhysicsBody*> bodies_;
  double seconds_ = 0;
};

bool contest(const std::string& scene, std::int64_t objects, std::uint32_t frames) {
  Contestant plain("plain loop", scene, objects, [](const PhysicsSettings& settings) {
    return std::make_unique<PlainBullet>(settings);
  });
  Contestant ours("bullet", scene, objects, [](const PhysicsSettings& settings) {
    const std::vector<EngineEntry> entries = engineEntries();
    return std::ranges::find(entries, "bullet",
                             [](const EngineEntry& entry) { return entry.listing.id; })
        ->create(settings);
  });
  for (std::uint32_t frame = 1; frame <= frames; ++frame) {
    plain.advance(frame);
    ours.advance(frame);
  }
  const double ratio = plain.seconds() / ours.seconds();
  fmt::print(
      "{:10} {:6} cubes {:4} frames  {} {:7.2f} s  {} {:7.2f} s  {:5.2f}x  target 1.00x  {}\n",
      scene, objects, frames, plain.name(), plain.seconds(), ours.name(), ours.seconds(), ratio,
      ratio >= 1 ? "ok" : "MISSED");
  return ratio >= 1;
}

}  // namespace

int main(int argc, char** argv) {
  const int objects = argc > 1 ? std::max(1, std::atoi(argv[1])) : 8000;
  const int frames = argc > 2 ? std::max(1, std::atoi(argv[2])) : 200;
  bool met = contest("brownian", objects, static_cast<std::uint32_t>(frames));
  met &= contest("gravity", objects, static_cast<std::uint32_t>(frames));
  return met ? EXIT_SUCCESS : EXIT_FAILURE;
}
