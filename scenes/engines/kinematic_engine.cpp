// Bodies that move, turn and bounce at the walls, but pass through each other: O(n) per step, for
// scenes of millions of bodies. No body ever pushes another away from a wall, so what happens there
// is exact: without loss at the walls, bodies that are spread evenly stay so, however fast they
// are.

#include <algorithm>
#include <cmath>
#include <vector>

#include "broadmark/scenes/body_pool.h"
#include "broadmark/scenes/registry.h"
#include "entries.h"

namespace broadmark::scenes::kinematic_engine {
namespace {

/// Time of slow motion before a body falls asleep, in seconds. A body at the apex of its path is
/// slow for a shorter time.
constexpr double kTimeToSleep = 1;

/// Rounds of impacts at all walls in one substep. Opposite walls give more only to a body that
/// crosses the world many times in a substep, or is larger than the world.
constexpr int kMaxRounds = 16;

float dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// a + factor · b.
Vec3 plus(const Vec3& a, float factor, const Vec3& b) {
  return {a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]};
}

Vec3 times(const Vec3& v, float factor) { return plus({}, factor, v); }

/// The rotation after turning at this angular velocity for a short time: to first order, then
/// normalised. Library functions might round differently on other machines.
std::array<float, 4> turned(const std::array<float, 4>& q, const Vec3& w, float time) {
  const float h = time / 2;
  std::array<float, 4> result = {q[0] + h * (w[0] * q[3] + w[1] * q[2] - w[2] * q[1]),
                                 q[1] + h * (w[1] * q[3] + w[2] * q[0] - w[0] * q[2]),
                                 q[2] + h * (w[2] * q[3] + w[0] * q[1] - w[1] * q[0]),
                                 q[3] - h * (w[0] * q[0] + w[1] * q[1] + w[2] * q[2])};
  const float length = std::sqrt(result[0] * result[0] + result[1] * result[1] +
                                 result[2] * result[2] + result[3] * result[3]);
  for (float& component : result) component /= length;
  return result;
}

/// Shared by all bodies.
struct World {
  std::vector<HalfSpace> walls;
  Vec3 gravity{};
  float time = 0;           ///< of a substep
  float linear_factor = 1;  ///< fraction of a velocity left by damping after a substep
  float angular_factor = 1;
  float friction = 0;
  float restitution = 0;
  float max_angular_speed = 0;
  float sleep_threshold = 0;
  std::int64_t substeps_to_sleep = 0;
};

class KinematicBody : public PhysicsBody {
 public:
  explicit KinematicBody(const BodyDescription& body)
      : shape_(body.shape),
        pose_(body.pose),
        linear_(body.linear_velocity),
        angular_(body.angular_velocity) {
    measure();
  }

  [[nodiscard]] const Shape& shape() const override { return shape_; }
  [[nodiscard]] Pose pose() const override { return pose_; }
  [[nodiscard]] Vec3 linearVelocity() const override { return linear_; }
  [[nodiscard]] Vec3 angularVelocity() const override { return angular_; }

  void setPose(const Pose& pose) override {
    pose_ = pose;
    measure();
    wake();
  }

  void setVelocity(const Vec3& linear, const Vec3& angular) override {
    if (frozen_) return;
    linear_ = linear;
    angular_ = angular;
    wake();
  }

  [[nodiscard]] bool asleep() const override { return asleep_; }
  [[nodiscard]] bool frozen() const override { return frozen_; }

  void freeze() override {
    frozen_ = true;
    fallAsleep();
  }

  /// No effect on a frozen body.
  void wake() {
    asleep_ = frozen_;
    slow_substeps_ = 0;
    slowed_ = false;
  }

  /// One substep of a body that is awake.
  void move(const World& world) {
    // Exact under constant gravity.
    pose_.position = plus(pose_.position, world.time, plus(linear_, world.time / 2, world.gravity));
    linear_ = times(plus(linear_, world.time, world.gravity), world.linear_factor);
    if (angular_ != Vec3{}) turn(world);
    if (bounceAtWalls(world)) slowed_ = slowed_ || world.restitution < 1 || world.friction > 0;
    rest(world);
  }

 private:
  /// Updates half_size_.
  void measure() {
    const Aabb box = tightBox(shape_, {.rotation = pose_.rotation});
    std::copy_n(box.max.begin(), 3, half_size_.begin());
  }

  void turn(const World& world) {
    const float speed = std::sqrt(dot(angular_, angular_));
    const float limit = std::min(1.0F, world.max_angular_speed / speed);
    angular_ = times(angular_, world.angular_factor * limit);
    pose_.rotation = turned(pose_.rotation, angular_, world.time);
    measure();
  }

  /// How far the tight box is behind the wall; negative: its distance.
  [[nodiscard]] float depthBehind(const HalfSpace& wall) const {
    const Vec3& normal = wall.normal;
    const float reach = std::abs(normal[0]) * half_size_[0] + std::abs(normal[1]) * half_size_[1] +
                        std::abs(normal[2]) * half_size_[2];
    return wall.offset - (dot(normal, pose_.position) - reach);
  }

  /// Whether there was an impact.
  bool bounceAtWalls(const World& world) {
    bool touched = false;
    for (int round = 0; round < kMaxRounds; ++round) {
      bool left = false;  // a wall, perhaps for the opposite one
      for (const HalfSpace& wall : world.walls) {
        const float depth = depthBehind(wall);
        if (depth <= 0) continue;
        touched = true;
        left |= bounce(wall, depth, world);
      }
      if (!left) return touched;
    }
    for (const HalfSpace& wall : world.walls) {
      const float depth = depthBehind(wall);
      if (depth > 0) pose_.position = plus(pose_.position, depth, wall.normal);
    }
    return true;
  }

  /// Moves the tight box out of the wall and applies the impact: restitution reflects the normal
  /// velocity, friction slows the tangential velocity. The body moves away for as long as it would
  /// have been behind the wall: if it stopped there, fast bodies would gather at the walls. Returns
  /// whether it left the wall.
  bool bounce(const HalfSpace& wall, float depth, const World& world) {
    const Vec3& normal = wall.normal;
    pose_.position = plus(pose_.position, depth, normal);
    const float approach = -dot(normal, linear_);
    if (approach <= 0) return false;
    // Subtracts the speed gained from gravity behind the wall: otherwise every impact would add
    // energy.
    const float gravity_gain = -2 * dot(normal, world.gravity) * depth;
    const float impact = std::sqrt(std::max(0.0F, approach * approach - gravity_gain));
    const Vec3 sideways = plus(linear_, approach, normal);
    const float sideways_speed = std::sqrt(dot(sideways, sideways));
    const float friction_speed = world.friction * (approach + world.restitution * impact);
    const float remaining =
        sideways_speed > friction_speed ? 1 - friction_speed / sideways_speed : 0;
    const float time = std::min(world.time, 2 * depth / (approach + impact));
    const float gained = dot(normal, world.gravity) * time;
    float departure = world.restitution * impact;
    const float height = time * (departure + gained / 2);
    if (height > 0) {
      pose_.position = plus(pose_.position, height, normal);
      departure += gained;
    }
    linear_ = plus(times(sideways, remaining), departure, normal);
    return height > 0;
  }

  /// Falls asleep after a time of low energy, unless nothing slows it: a slow body in free flight
  /// flies on.
  void rest(const World& world) {
    slowed_ = slowed_ || world.gravity != Vec3{} || world.linear_factor < 1;
    const float energy =
        dot(linear_, linear_) / 2 + dot(angular_, angular_) * dot(half_size_, half_size_) / 6;
    slow_substeps_ = energy < world.sleep_threshold ? slow_substeps_ + 1 : 0;
    if (slow_substeps_ == 0) slowed_ = false;
    if (slow_substeps_ >= world.substeps_to_sleep && (slowed_ || linear_ == Vec3{})) fallAsleep();
  }

  void fallAsleep() {
    asleep_ = true;
    linear_ = angular_ = {};
  }

  Shape shape_;
  Pose pose_;
  Vec3 linear_;
  Vec3 angular_;
  Vec3 half_size_{};  ///< of the tight box
  bool frozen_ = false;
  bool asleep_ = false;
  std::int64_t slow_substeps_ = 0;
  bool slowed_ = false;  ///< something slowed it since it became slow
};

class KinematicEngine final : public PhysicsEngine {
 public:
  explicit KinematicEngine(const PhysicsSettings& settings) : substeps_(settings.substeps) {
    const double time = settings.time_step / static_cast<double>(settings.substeps);
    world_.time = static_cast<float>(time);
    world_.linear_factor = static_cast<float>(std::pow(1 - settings.linear_damping, time));
    world_.angular_factor = static_cast<float>(std::pow(1 - settings.angular_damping, time));
    world_.friction = static_cast<float>(settings.friction);
    world_.restitution = static_cast<float>(settings.restitution);
    world_.max_angular_speed = static_cast<float>(settings.max_angular_speed);
    world_.sleep_threshold = static_cast<float>(settings.sleep_threshold);
    world_.substeps_to_sleep = static_cast<std::int64_t>(std::ceil(kTimeToSleep / time));
  }

  /// No effect: bodies pass through each other.
  void setLayers(const LayerMatrix&) override {}

  PhysicsBody& addBody(const BodyDescription& description) override {
    return bodies_.add(description);
  }

  void removeBody(PhysicsBody& body) override { bodies_.remove(static_cast<KinematicBody&>(body)); }

  void addWall(const HalfSpace& wall) override { world_.walls.push_back(wall); }

  void setGravity(const Vec3& gravity) override {
    if (gravity == world_.gravity) return;
    world_.gravity = gravity;
    bodies_.each([](KinematicBody& body) { body.wake(); });
  }

  [[nodiscard]] Vec3 gravity() const override { return world_.gravity; }

  void step() override {
    bodies_.each([this](KinematicBody& body) {
      for (std::int64_t i = 0; i < substeps_ && !body.asleep(); ++i) body.move(world_);
    });
  }

  [[nodiscard]] bool allAsleep() const override {
    return bodies_.all([](const KinematicBody& body) { return body.asleep(); });
  }

 private:
  std::int64_t substeps_;
  World world_;
  BodyPool<KinematicBody> bodies_;
};

}  // namespace

EngineEntry entry() {
  return {{"kinematic", "bodies bounce off the walls and pass through each other: fast",
           Dynamics::passing},
          makeEntry<PhysicsEngine, KinematicEngine>};
}

}  // namespace broadmark::scenes::kinematic_engine
