// Measures the Bullet engine against a plain loop over Bullet's world with its defaults: the same
// bodies, walls, time step and iterations, and the same actions of the scenes Brownian and Gravity.
// Or, with --settings, the effect of single settings of Bullet, in the plain loop. Contestants
// alternate frame by frame and are measured by the CPU time of their thread, so that background
// load affects all of them. Exit status 1 if the engine is slower than the plain loop.
//
// With --record the plain loop runs other scenes and writes what to audit (docs/integrations.md):
// the boxes and the pair cache of Bullet's tree and of its sweep, in the current folder.
//
//   plain_bullet [--settings|--record] [OBJECTS [FRAMES]]

#include <BulletCollision/BroadphaseCollision/btAxisSweep3.h>
#include <BulletDynamics/ConstraintSolver/btNNCGConstraintSolver.h>
#include <btBulletDynamicsCommon.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "broadmark/error.h"
#include "broadmark/scenes/scene.h"
#include "integrations/bullet.h"

// Margins are global to the process: each contestant sets them before its step.
extern btScalar gContactBreakingThreshold;
extern btScalar gDbvtMargin;

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
  void setPose(const Pose&) override {}  // not called by these scenes
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

/// Settings of Bullet. The defaults are those of its manual.
struct Setup {
  std::string name;
  bool sweep_and_prune = false;     ///< as broad phase, instead of the tree
  bool pairs_at_once = false;       ///< searched in one pass over the tree (m_deferedcollide)
  int tree_improvement = 0;         ///< per cent of the tree in each step (m_dupdates)
  bool sleepers_keep_box = false;   ///< the broad phase does not update sleeping bodies
  btScalar tree_margin = 0.05F;     ///< maximum movement of a body without a tree update
  btScalar contact_margin = 0.02F;  ///< maximum distance of retained contacts
  bool conjugate_gradients = false;
  bool warm_start = true;
  bool two_friction_directions = false;
  bool split_impulse = true;  ///< separates bodies without adding velocity
  bool continuous = true;     ///< continuous collision detection, for fast bodies
  bool gyroscopic = true;
};

/// The settings of the engine `bullet`.
const Setup kInUse = {.name = "as in use",
                      .pairs_at_once = true,
                      .tree_improvement = 1,
                      .sleepers_keep_box = true,
                      .two_friction_directions = true};

/// The settings in use, then variations with a single change each.
std::vector<Setup> variations() {
  std::vector<Setup> setups = {kInUse};
  const auto add = [&](const char* name, const std::function<void(Setup&)>& change) {
    Setup setup = kInUse;
    setup.name = name;
    change(setup);
    setups.push_back(setup);
  };
  add("sweep and prune (bt32BitAxisSweep3)", [](Setup& s) { s.sweep_and_prune = true; });
  add("pairs searched body by body", [](Setup& s) { s.pairs_at_once = false; });
  add("tree not improved", [](Setup& s) { s.tree_improvement = 0; });
  add("tree improved by 5 % per step", [](Setup& s) { s.tree_improvement = 5; });
  add("boxes of sleepers updated, too", [](Setup& s) { s.sleepers_keep_box = false; });
  add("tree margin 0.01 instead of 0.05", [](Setup& s) { s.tree_margin = 0.01F; });
  add("tree margin 0.2", [](Setup& s) { s.tree_margin = 0.2F; });
  add("contact margin 0.005 instead of 0.02", [](Setup& s) { s.contact_margin = 0.005F; });
  add("contact margin 0.08", [](Setup& s) { s.contact_margin = 0.08F; });
  add("nonsmooth conjugate gradients", [](Setup& s) { s.conjugate_gradients = true; });
  add("no warm start", [](Setup& s) { s.warm_start = false; });
  add("one friction direction", [](Setup& s) { s.two_friction_directions = false; });
  add("no split impulse", [](Setup& s) { s.split_impulse = false; });
  add("no continuous pass", [](Setup& s) { s.continuous = false; });
  add("no gyroscopic term", [](Setup& s) { s.gyroscopic = false; });
  return setups;
}

std::unique_ptr<btBroadphaseInterface> broadPhase(const Setup& setup, double side) {
  if (setup.sweep_and_prune) {
    const auto half = static_cast<btScalar>(side);
    return std::make_unique<bt32BitAxisSweep3>(btVector3(-half, -half, -half),
                                               btVector3(half, half, half));
  }
  auto tree = std::make_unique<btDbvtBroadphase>();
  tree->m_deferedcollide = setup.pairs_at_once;
  tree->m_dupdates = setup.tree_improvement;
  return tree;
}

std::unique_ptr<btSequentialImpulseConstraintSolver> solver(const Setup& setup) {
  if (setup.conjugate_gradients) return std::make_unique<btNNCGConstraintSolver>();
  return std::make_unique<btSequentialImpulseConstraintSolver>();
}

/// A plain loop over Bullet's world.
class PlainBullet final : public PhysicsEngine {
 public:
  explicit PlainBullet(const Settings& settings, const Setup& setup = {})
      : settings_(settings.physics),
        setup_(setup),
        broad_phase_(broadPhase(setup, settings.side())),
        solver_(solver(setup)) {
    world_.setGravity(btVector3(0, 0, 0));
    world_.setForceUpdateAllAabbs(!setup.sleepers_keep_box);
    world_.getDispatchInfo().m_useContinuous = setup.continuous;
    btContactSolverInfo& info = world_.getSolverInfo();
    info.m_numIterations = static_cast<int>(settings_.solver_iterations);
    info.m_splitImpulse = setup.split_impulse ? 1 : 0;
    if (setup.two_friction_directions) info.m_solverMode |= SOLVER_USE_2_FRICTION_DIRECTIONS;
    if (!setup.warm_start) info.m_solverMode &= ~SOLVER_USE_WARMSTARTING;
  }
  ~PlainBullet() override {
    for (PlainBody& body : bodies_) {
      if (body.body.isInWorld()) world_.removeRigidBody(&body.body);
    }
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
    if (!setup_.gyroscopic) body.body.setFlags(0);
    world_.addRigidBody(&body.body);
    return body;
  }

  void setLayers(const LayerMatrix&) override {}
  void removeBody(PhysicsBody& body) override {
    world_.removeRigidBody(&static_cast<PlainBody&>(body).body);
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
  [[nodiscard]] Vec3 gravity() const override {
    const btVector3 g = world_.getGravity();
    return {g.x(), g.y(), g.z()};
  }

  void step() override {
    gContactBreakingThreshold = setup_.contact_margin;
    gDbvtMargin = setup_.tree_margin;
    const auto substeps = static_cast<int>(settings_.substeps);
    const auto time = static_cast<btScalar>(settings_.time_step);
    world_.stepSimulation(time, substeps, time / static_cast<btScalar>(substeps));
  }

  [[nodiscard]] bool allAsleep() const override { return false; }

  [[nodiscard]] btCollisionWorld& world() { return world_; }

  /// Mean penetration depth over all penetrating contact points.
  [[nodiscard]] double meanPenetration() {
    double sum = 0;
    int points = 0;
    for (int i = 0; i < dispatcher_.getNumManifolds(); ++i) {
      const btPersistentManifold& manifold = *dispatcher_.getManifoldByIndexInternal(i);
      for (int k = 0; k < manifold.getNumContacts(); ++k) {
        const btScalar distance = manifold.getContactPoint(k).getDistance();
        if (distance >= 0) continue;
        sum -= double{distance};
        ++points;
      }
    }
    return points > 0 ? sum / points : 0;
  }

 private:
  PhysicsSettings settings_;
  Setup setup_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  std::unique_ptr<btBroadphaseInterface> broad_phase_;
  std::unique_ptr<btSequentialImpulseConstraintSolver> solver_;
  std::unique_ptr<btBoxShape> shape_;
  std::deque<btStaticPlaneShape> wall_shapes_;
  std::deque<btRigidBody> walls_;
  std::deque<PlainBody> bodies_;
  btDiscreteDynamicsWorld world_{&dispatcher_, broad_phase_.get(), solver_.get(), &configuration_};
};

/// CPU time of this thread.
double threadSeconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// An engine with a scene.
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
    engine_ = make_engine(settings_);
    for (int axis = 0; axis < 3; ++axis) {
      for (const float sign : {1.0F, -1.0F}) {
        HalfSpace wall{.offset = static_cast<float>(-settings_.side() / 2)};
        wall.normal[axis] = sign;
        engine_->addWall(wall);
      }
    }
    SceneInfo info{.objects = static_cast<std::uint32_t>(objects)};
    scene_->describe(settings_, info);
    bodies_.emplace(*engine_, info);
    scene_->prepare(settings_, random_);
    Stage stage = makeStage();
    scene_->populate(stage);
    scene_->start(stage);
  }

  void advance(
      std::uint32_t frame, const std::function<void(PhysicsEngine&)>& stepped = [](auto&) {}) {
    const double start = threadSeconds();
    engine_->step();
    seconds_ += threadSeconds() - start;
    stepped(*engine_);
    bodies_->record(frame);
    Stage stage = makeStage();
    scene_->act(stage, frame);
  }

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] double seconds() const { return seconds_; }
  [[nodiscard]] PhysicsEngine& engine() { return *engine_; }

 private:
  Stage makeStage() { return {settings_, cubes_, *engine_, *bodies_, random_}; }

  std::string name_;
  std::unique_ptr<Scene> scene_;
  Settings settings_;
  Random random_{1};
  std::unique_ptr<PhysicsEngine> engine_;
  const ObjectType cubes_ = objectTypes().front();
  std::optional<Bodies> bodies_;
  double seconds_ = 0;
};

bool contest(const std::string& scene, std::int64_t objects, std::uint32_t frames) {
  Contestant plain("plain loop", scene, objects, [](const Settings& settings) {
    return std::make_unique<PlainBullet>(settings);
  });
  Contestant ours("bullet", scene, objects, [](const Settings& settings) {
    const std::vector<EngineEntry> entries = engineEntries();
    return std::ranges::find(entries, "bullet",
                             [](const EngineEntry& entry) { return entry.listing.id; })
        ->create(settings.physics);
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

/// Prints the cost of each variation relative to the settings in use, and its mean penetration.
void compareSettings(const std::string& scene, std::int64_t objects, std::uint32_t frames) {
  std::deque<Contestant> contestants;
  for (const Setup& setup : variations()) {
    contestants.emplace_back(setup.name, scene, objects, [&](const Settings& settings) {
      return std::make_unique<PlainBullet>(settings, setup);
    });
  }
  for (std::uint32_t frame = 1; frame <= frames; ++frame) {
    for (Contestant& contestant : contestants) contestant.advance(frame);
  }
  fmt::print("{}, {} cubes, {} frames\n", scene, objects, frames);
  for (Contestant& contestant : contestants) {
    fmt::print("  {:38} {:7.2f} s  {:5.2f}x  mean penetration {:.4f}\n", contestant.name(),
               contestant.seconds(), contestant.seconds() / contestants.front().seconds(),
               dynamic_cast<PlainBullet&>(contestant.engine()).meanPenetration());
  }
}

/// Records the boxes that Bullet's broad phase was given in each frame, and the pairs in its cache.
void recordSession(const std::string& scene, const Setup& setup, std::int64_t objects,
                   std::uint32_t frames) {
  Contestant plain(setup.name, scene, objects, [&](const Settings& settings) {
    return std::make_unique<PlainBullet>(settings, setup);
  });
  const std::string name = scene + "-" + setup.name;
  broadmark_recorder recorder;
  broadmark_record_begin(&recorder, name.c_str(), static_cast<std::uint32_t>(objects + 6));
  for (std::uint32_t frame = 1; frame <= frames; ++frame) {
    plain.advance(frame, [&](PhysicsEngine& engine) {
      broadmarkRecord(recorder, dynamic_cast<PlainBullet&>(engine).world());
    });
  }
  if (broadmark_record_end(&recorder) == 0) {
    throw InputError(fmt::format("{}: {}", name, recorder.error));
  }
  fmt::print("written: {0}.broadmark, {0}.csv\n", name);
}

int number(std::span<char*> arguments, std::size_t index, int fallback) {
  return index < arguments.size() ? std::max(1, std::atoi(arguments[index])) : fallback;
}

}  // namespace

int main(int argc, char** argv) try {
  std::span<char*> arguments(argv + 1, static_cast<std::size_t>(argc - 1));
  const auto option = [&](std::string_view name) { return argc > 1 && argv[1] == name; };
  const bool settings = option("--settings");
  const bool record = option("--record");
  if (settings || record) arguments = arguments.subspan(1);
  const int objects = number(arguments, 0, settings || record ? 2000 : 8000);
  const auto frames = static_cast<std::uint32_t>(number(arguments, 1, settings ? 60 : 200));
  if (record) {
    const Setup setups[] = {{.name = "tree"},
                            {.name = "tree-without-margin", .tree_margin = 0},
                            {.name = "sweep", .sweep_and_prune = true}};
    for (const char* scene : {"freefall", "gravity", "fountain"}) {
      for (const Setup& setup : setups) recordSession(scene, setup, objects, frames);
    }
    return EXIT_SUCCESS;
  }
  bool met = true;
  for (const char* scene : {"brownian", "gravity"}) {
    if (settings) {
      compareSettings(scene, objects, frames);
    } else {
      met &= contest(scene, objects, frames);
    }
  }
  return met ? EXIT_SUCCESS : EXIT_FAILURE;
} catch (const InputError& error) {
  fmt::print(stderr, "plain_bullet: {}\n", error.what());
  return 2;
}
