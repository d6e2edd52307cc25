// Explosion: a dense ball of tumbling bodies flies apart until the walls stop it. At first all
// bodies are in a small part of the world; their density falls in every frame.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "broadmark/scenes/scene.h"
#include "entries.h"

namespace broadmark::scenes::explosion {
namespace {

using Point = std::array<int, 3>;

int lengthSquared(const Point& p) { return p[0] * p[0] + p[1] * p[1] + p[2] * p[2]; }

/// The `count` points of the integer lattice nearest to the origin, in ascending distance.
std::vector<Point> ballOfPoints(std::size_t count) {
  const double radius = std::cbrt(3 * static_cast<double>(count) / (4 * std::numbers::pi));
  const int reach = static_cast<int>(radius) + 2;  // a ball with more than `count` points
  std::vector<Point> points;
  for (int x = -reach; x <= reach; ++x) {
    for (int y = -reach; y <= reach; ++y) {
      for (int z = -reach; z <= reach; ++z) {
        if (lengthSquared({x, y, z}) <= reach * reach) points.push_back({x, y, z});
      }
    }
  }
  std::ranges::stable_sort(points, {}, lengthSquared);
  points.resize(count);
  return points;
}

class Explosion final : public Scene {
 public:
  void setDefaults(Settings& settings) const override {
    settings.density = 0.005;
    settings.initial_radius = 0.13;  // unit cubes just do not touch
    settings.initial_speed = 0.25;
    settings.gravity = 0.03;
    settings.physics.restitution = 0.5;
  }

  void visitParameters(const ParameterVisitor& visit) override {
    visit({"jitter", "initial displacement of bodies from the lattice, in lattice spacings",
           &jitter_, 0, 1});
    visit({"slowest", "minimum outward speed, as a share of the maximum at that distance",
           &slowest_, 0, 1});
    visit({"tumbling", "largest angular speed at the start, in radians per second", &tumbling_, 0,
           1000});
  }

  void prepare(const Settings& settings, Random& random) override {
    const auto count = static_cast<std::size_t>(settings.objects);
    lattice_points_ = ballOfPoints(count);
    outermost_ = count > 1 ? std::sqrt(lengthSquared(lattice_points_.back())) : 1;
    // The volume of the ball in lattice cells is the number of bodies.
    const double lattice_radius =
        std::cbrt(3 * static_cast<double>(count) / (4 * std::numbers::pi));
    spacing_ = settings.initial_radius * settings.side() / lattice_radius;
    random.shuffle(lattice_points_);  // ids must be independent of positions
  }

  void place(std::size_t index, BodyDescription& body, const Settings& settings,
             Random& random) override {
    const double speed = settings.initial_speed * settings.side() * random.between(slowest_, 1);
    for (int axis = 0; axis < 3; ++axis) {
      const double coordinate = lattice_points_[index][axis] + jitter_ * random.between(-0.5, 0.5);
      body.pose.position[axis] = static_cast<float>(spacing_ * coordinate);
      body.linear_velocity[axis] =
          static_cast<float>(speed * lattice_points_[index][axis] / outermost_);
    }
    body.angular_velocity = random.inBall(tumbling_);
  }

 private:
  double jitter_ = 0.15;
  double slowest_ = 0.4;
  double tumbling_ = 4;
  std::vector<Point> lattice_points_;  ///< by body, in the lattice
  double outermost_ = 1;               ///< distance of the farthest point
  double spacing_ = 1;
};

}  // namespace

SceneEntry entry() {
  return {{"explosion", "Explosion", "a dense ball of bodies flies apart"},
          makeEntry<Scene, Explosion>};
}

}  // namespace broadmark::scenes::explosion
