// Boids: birds of a flock instead of bodies under forces. Boids keep their distance from
// neighbours, align with them and stay near them, at about their launch speeds. Bodies do not
// collide; they avoid walls and never pass them. O(n) per step: neighbours are found in a uniform
// grid, and a boid follows at most kMaxNeighbours.
//
// C. Reynolds: Flocks, Herds, and Schools: A Distributed Behavioral Model. SIGGRAPH 1987.
// M. Teschner et al.: Optimized Spatial Hashing for Collision Detection of Deformable Objects.
// VMV 2003 (the table of cells).

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "broadmark/scenes/body_pool.h"
#include "broadmark/scenes/registry.h"
#include "entries.h"

namespace broadmark::scenes::boids_engine {
namespace {

using Eigen::Vector3f;

/// Sufficient for dense flocks: real birds follow far fewer.
constexpr int kMaxNeighbours = 64;

Vector3f toEigen(const Vec3& v) { return Vector3f(v.data()); }
Vec3 fromEigen(const Vector3f& v) { return {v.x(), v.y(), v.z()}; }

Vector3f halfExtents(const Shape& shape, const Pose& pose) {
  const Aabb box = tightBox(shape, pose);
  return (Vector3f(box.max.data()) - Vector3f(box.min.data())) / 2;
}

/// The rotation that points x along `velocity` and keeps z level.
std::array<float, 4> headingAlong(const Vector3f& velocity) {
  const Vector3f forward = velocity.normalized();
  const Vector3f level = forward.cross(Vector3f::UnitY());
  const Vector3f right = level.norm() > 1e-3F ? level.normalized() : Vector3f::UnitZ();
  Eigen::Matrix3f axes;
  axes << forward, right.cross(forward).normalized(), right;
  const Eigen::Quaternionf rotation(axes);
  return {rotation.x(), rotation.y(), rotation.z(), rotation.w()};
}

class Boid : public PhysicsBody {
 public:
  explicit Boid(const BodyDescription& description)
      : shape_(description.shape),
        pose_(description.pose),
        size_(2.0 / 3 * double{halfExtents(description.shape, {}).sum()}) {
    launch(toEigen(description.linear_velocity));
  }

  [[nodiscard]] const Shape& shape() const override { return shape_; }
  [[nodiscard]] Pose pose() const override { return pose_; }
  [[nodiscard]] Vec3 linearVelocity() const override { return fromEigen(velocity_); }
  [[nodiscard]] Vec3 angularVelocity() const override { return {}; }
  void setPose(const Pose& pose) override { pose_ = pose; }
  void setVelocity(const Vec3& linear, const Vec3&) override {
    if (!frozen_) launch(toEigen(linear));
  }
  [[nodiscard]] bool asleep() const override { return cruising_speed_ == 0; }
  [[nodiscard]] bool frozen() const override { return frozen_; }
  void freeze() override {
    launch(Vector3f::Zero());
    frozen_ = true;
  }

  [[nodiscard]] Vector3f position() const { return toEigen(pose_.position); }
  [[nodiscard]] const Vector3f& velocity() const { return velocity_; }
  /// The mean edge of its unrotated box.
  [[nodiscard]] double size() const { return size_; }
  /// The launch speed, which the boid tends to keep.
  [[nodiscard]] float cruisingSpeed() const { return cruising_speed_; }

  /// Flies with this velocity and turns into its direction.
  void fly(const Vector3f& velocity, float seconds) {
    velocity_ = velocity;
    pose_.position = fromEigen(position() + seconds * velocity);
    if (!velocity.isZero(0)) pose_.rotation = headingAlong(velocity);
  }
  /// Moves without changing the velocity.
  void push(const Vector3f& displacement) { pose_.position = fromEigen(position() + displacement); }
  /// Removes the part of the velocity against `normal`.
  void slideAlong(const Vector3f& normal) {
    velocity_ -= std::min(0.0F, velocity_.dot(normal)) * normal;
  }

 private:
  void launch(const Vector3f& velocity) {
    velocity_ = velocity;
    cruising_speed_ = velocity.norm();
  }

  Shape shape_;
  Pose pose_;
  double size_;
  Vector3f velocity_ = Vector3f::Zero();
  float cruising_speed_ = 0;
  bool frozen_ = false;
};

/// Hashes points by their cell in an unbounded uniform grid, into at least as many buckets as
/// points.
class CellTable {
 public:
  void rebuild(const std::vector<Vector3f>& points, float cell_edge) {
    cell_edge_ = cell_edge;
    bucket_mask_ = static_cast<std::uint32_t>(std::bit_ceil(points.size() | 1)) - 1;
    cells_.resize(points.size());
    std::ranges::transform(points, cells_.begin(), [&](const Vector3f& p) { return cellOf(p); });
    // Counting sort by bucket, stable: points of a cell are visited in order.
    starts_.assign(bucket_mask_ + 2, 0);
    for (const Cell& cell : cells_) ++starts_[bucketOf(cell) + 1];
    for (std::size_t bucket = 1; bucket < starts_.size(); ++bucket) {
      starts_[bucket] += starts_[bucket - 1];
    }
    next_.assign(starts_.begin(), starts_.end() - 1);
    points_.resize(points.size());
    for (std::uint32_t i = 0; i < cells_.size(); ++i) points_[next_[bucketOf(cells_[i])]++] = i;
  }

  /// Calls visit(index) for the points in the cells around `point` until it returns false.
  template <class Visit>
  void eachNear(const Vector3f& point, Visit&& visit) const {
    const Cell centre = cellOf(point);
    for (const int dx : {0, -1, 1}) {
      for (const int dy : {0, -1, 1}) {
        for (const int dz : {0, -1, 1}) {
          const Cell cell = {centre[0] + dx, centre[1] + dy, centre[2] + dz};
          const std::uint32_t bucket = bucketOf(cell);
          for (std::uint32_t k = starts_[bucket]; k < starts_[bucket + 1]; ++k) {
            if (cells_[points_[k]] == cell && !visit(points_[k])) return;
          }
        }
      }
    }
  }

 private:
  using Cell = std::array<int, 3>;

  [[nodiscard]] Cell cellOf(const Vector3f& point) const {
    constexpr float kMaxCell = 1e9F;  // fits into an int
    Cell cell;
    for (int axis = 0; axis < 3; ++axis) {
      const float index = std::floor(point[axis] / cell_edge_);
      cell[axis] = static_cast<int>(std::clamp(index, -kMaxCell, kMaxCell));
    }
    return cell;
  }

  [[nodiscard]] std::uint32_t bucketOf(const Cell& cell) const {
    constexpr std::uint32_t kPrimes[] = {73856093, 19349663, 83492791};
    std::uint32_t hash = 0;
    for (int axis = 0; axis < 3; ++axis) {
      hash ^= static_cast<std::uint32_t>(cell[axis]) * kPrimes[axis];
    }
    return hash & bucket_mask_;
  }

  float cell_edge_ = 1;
  std::uint32_t bucket_mask_ = 0;
  std::vector<Cell> cells_;            ///< by point
  std::vector<std::uint32_t> starts_;  ///< start of each bucket in points_, and the end
  std::vector<std::uint32_t> next_;    ///< insertion index of each bucket
  std::vector<std::uint32_t> points_;  ///< indices, sorted by bucket
};

class BoidsEngine final : public PhysicsEngine {
 public:
  explicit BoidsEngine(const PhysicsSettings& settings) : settings_(settings) {}

  void visitParameters(const ParameterVisitor& visit) override {
    visit({"sight", "distance at which a boid sees neighbours, in mean body sizes", &sight_, 1e-3,
           1e3});
    visit({"elbow_room", "distance that a boid keeps from others, in mean body sizes", &elbow_room_,
           0, 1e3});
    visit({"separation", "strength of keeping that distance, per second", &separation_, 0, 100});
    visit({"alignment", "strength of matching the velocity of its neighbours, per second",
           &alignment_, 0, 100});
    visit({"cohesion", "strength of approaching the centre of its neighbours, per second",
           &cohesion_, 0, 100});
    visit({"foresight", "time before reaching a wall at which a boid starts to turn, in seconds",
           &foresight_, 1e-3, 100});
    visit({"min_speed", "minimum speed, as a multiple of the launch speed", &min_speed_, 0, 1});
    visit({"max_speed", "maximum speed, as a multiple of the launch speed", &max_speed_, 1, 100});
  }

  /// No effect: boids pass through each other.
  void setLayers(const LayerMatrix&) override {}
  PhysicsBody& addBody(const BodyDescription& description) override {
    return bodies_.add(description);
  }
  void removeBody(PhysicsBody& body) override { bodies_.remove(static_cast<Boid&>(body)); }
  void addWall(const HalfSpace& wall) override { walls_.push_back(wall); }
  void setGravity(const Vec3& gravity) override { gravity_ = toEigen(gravity); }
  [[nodiscard]] Vec3 gravity() const override { return fromEigen(gravity_); }

  void step() override {
    const auto seconds =
        static_cast<float>(settings_.time_step / static_cast<double>(settings_.substeps));
    boids_.clear();
    bodies_.each([this](Boid& boid) { boids_.push_back(&boid); });
    for (std::int64_t i = 0; i < settings_.substeps; ++i) {
      steer(seconds);
      fly(seconds);
    }
  }

  [[nodiscard]] bool allAsleep() const override {
    return bodies_.all([](const Boid& boid) { return boid.asleep(); });
  }

 private:
  /// Computes all new velocities before any boid moves.
  void steer(float seconds) {
    if (boids_.empty()) return;
    positions_.clear();
    double size_sum = 0;
    for (const Boid* boid : boids_) {
      positions_.push_back(boid->position());
      size_sum += boid->size();
    }
    const auto body_size = static_cast<float>(size_sum / static_cast<double>(boids_.size()));
    const float sight = static_cast<float>(sight_) * body_size;
    const float elbow_room = std::min(static_cast<float>(elbow_room_) * body_size, sight);
    cells_.rebuild(positions_, sight);
    velocities_.resize(boids_.size());
    for (std::size_t i = 0; i < boids_.size(); ++i) {
      const Boid& boid = *boids_[i];
      if (boid.asleep()) continue;
      const Vector3f acceleration =
          gravity_ +
          boid.cruisingSpeed() * (flockSteering(i, sight, elbow_room) + wallSteering(boid));
      velocities_[i] = clampedSpeed(boid.velocity() + seconds * acceleration, boid);
    }
  }

  /// The three boids rules: an acceleration per cruising speed.
  [[nodiscard]] Vector3f flockSteering(std::size_t self, float sight, float elbow_room) const {
    const Boid& boid = *boids_[self];
    Vector3f away = Vector3f::Zero();
    Vector3f velocities = Vector3f::Zero();
    Vector3f offsets = Vector3f::Zero();
    int seen = 0;
    int leaders = 0;
    cells_.eachNear(positions_[self], [&](std::uint32_t other) {
      const Vector3f offset = positions_[other] - positions_[self];
      const float distance = offset.norm();
      if (other == self || distance > sight) return true;
      if (distance < elbow_room && distance > 0) away -= offset * (1 / distance - 1 / elbow_room);
      if (!boids_[other]->asleep()) {
        velocities += boids_[other]->velocity();
        offsets += offset;
        ++leaders;
      }
      return ++seen < kMaxNeighbours;
    });
    Vector3f steering = static_cast<float>(separation_) * away;
    if (leaders > 0) {
      const auto count = static_cast<float>(leaders);
      steering += static_cast<float>(alignment_) * (velocities / count - boid.velocity()) /
                  boid.cruisingSpeed();
      steering += static_cast<float>(cohesion_) * offsets / (count * sight);
    }
    return steering;
  }

  /// Steers away from walls, the more the nearer: an acceleration per cruising speed.
  [[nodiscard]] Vector3f wallSteering(const Boid& boid) const {
    const auto foresight = static_cast<float>(foresight_);
    const float range = foresight * boid.cruisingSpeed();
    const Vector3f half = halfExtents(boid.shape(), boid.pose());
    Vector3f steering = Vector3f::Zero();
    for (const HalfSpace& wall : walls_) {
      const Vector3f normal = toEigen(wall.normal);
      const float gap = depthInside(boid, wall) - normal.cwiseAbs().dot(half);
      // Three times the deceleration that would stop a boid flying straight at the wall.
      if (gap < range) steering += 3 / foresight * (1 - std::max(gap, 0.0F) / range) * normal;
    }
    return steering;
  }

  [[nodiscard]] Vector3f clampedSpeed(const Vector3f& velocity, const Boid& boid) const {
    const float speed = velocity.norm();
    if (speed == 0) return boid.velocity();
    const float target = std::clamp(speed, static_cast<float>(min_speed_) * boid.cruisingSpeed(),
                                    static_cast<float>(max_speed_) * boid.cruisingSpeed());
    return target / speed * velocity;
  }

  void fly(float seconds) {
    for (std::size_t i = 0; i < boids_.size(); ++i) {
      if (boids_[i]->asleep()) continue;
      boids_[i]->fly(velocities_[i], seconds);
      keepInside(*boids_[i]);
    }
  }

  /// Keeps the whole boid inside the walls; if it is larger than the world, its centre.
  void keepInside(Boid& boid) const {
    const Vector3f half = halfExtents(boid.shape(), boid.pose());
    for (const float share : {1.0F, 0.0F}) {
      for (const HalfSpace& wall : walls_) {
        const Vector3f normal = toEigen(wall.normal);
        const float penetration = share * normal.cwiseAbs().dot(half) - depthInside(boid, wall);
        if (penetration <= 0) continue;
        boid.push(penetration * normal);
        boid.slideAlong(normal);
      }
    }
  }

  /// The distance of the centre from a wall; negative: behind it.
  static float depthInside(const Boid& boid, const HalfSpace& wall) {
    return toEigen(wall.normal).dot(boid.position()) - wall.offset;
  }

  PhysicsSettings settings_;
  double sight_ = 4;
  double elbow_room_ = 2.4;
  double separation_ = 8;
  double alignment_ = 2;
  double cohesion_ = 3;
  double foresight_ = 0.8;
  double min_speed_ = 0.7;
  double max_speed_ = 1.4;

  BodyPool<Boid> bodies_;
  std::vector<Boid*> boids_;  ///< all bodies, during a step
  std::vector<HalfSpace> walls_;
  Vector3f gravity_ = Vector3f::Zero();
  CellTable cells_;
  std::vector<Vector3f> positions_;   ///< by boid, before the step
  std::vector<Vector3f> velocities_;  ///< by boid, from steer()
};

}  // namespace

EngineEntry entry() {
  return {{"boids", "a flock: bodies follow their neighbours and pass through each other",
           Dynamics::scripted},
          makeEntry<PhysicsEngine, BoidsEngine>};
}

}  // namespace broadmark::scenes::boids_engine
