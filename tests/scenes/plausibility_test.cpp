// Plausible physics: bodies stay in the world, do not penetrate each other, gain no energy and come
// to rest.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <tuple>

#include "broadmark/scenes/scene.h"
#include "entries.h"

namespace broadmark::scenes {
namespace {

using Vector = Eigen::Vector3d;

Vector vectorOf(const Vec3& v) { return {v[0], v[1], v[2]}; }

Eigen::Matrix3d rotationOf(const Pose& pose) {
  return Eigen::Quaternionf(pose.rotation.data()).cast<double>().normalized().toRotationMatrix();
}

double reach(const BoxShape& box, const Eigen::Matrix3d& rotation, const Vector& axis) {
  return vectorOf(box.half_extents).dot((rotation.transpose() * axis).cwiseAbs());
}

/// The penetration depth of two rotated boxes: the minimum overlap on the separating axes (face
/// normals and cross products of edges). Negative: a lower bound on the distance.
double depth(const BoxShape& a, const Pose& pose_a, const BoxShape& b, const Pose& pose_b) {
  const Eigen::Matrix3d turned_a = rotationOf(pose_a);
  const Eigen::Matrix3d turned_b = rotationOf(pose_b);
  const Vector between = vectorOf(pose_b.position) - vectorOf(pose_a.position);
  double least = 1e9;
  const auto test = [&](const Vector& direction) {
    if (direction.norm() < 1e-6) return;  // parallel edges
    const Vector axis = direction.normalized();
    least = std::min(
        least, reach(a, turned_a, axis) + reach(b, turned_b, axis) - std::abs(axis.dot(between)));
  };
  for (int i = 0; i < 3; ++i) {
    test(turned_a.col(i));
    test(turned_b.col(i));
    for (int j = 0; j < 3; ++j) test(turned_a.col(i).cross(turned_b.col(j)));
  }
  return least;
}

double depth(const SphereShape& a, const Pose& pose_a, const SphereShape& b, const Pose& pose_b) {
  return a.radius + b.radius - (vectorOf(pose_b.position) - vectorOf(pose_a.position)).norm();
}

/// The penetration depth of two bodies with the same kind of shape.
double depth(const PhysicsBody& a, const PhysicsBody& b) {
  return std::visit(
      [&]<class Form>(const Form& form) {
        return depth(form, a.pose(), std::get<Form>(b.shape()), b.pose());
      },
      a.shape());
}

/// The inertia per mass about the axes of the shape.
Vector inertia(const BoxShape& box) {
  const Vector squares = vectorOf(box.half_extents).cwiseAbs2();
  return (Vector::Constant(squares.sum()) - squares) / 3;
}
Vector inertia(const SphereShape& sphere) {
  return Vector::Constant(0.4 * sphere.radius * sphere.radius);
}

double kineticEnergy(const PhysicsBody& body) {
  const Vector turning = rotationOf(body.pose()).transpose() * vectorOf(body.angularVelocity());
  const Vector about = std::visit([](const auto& shape) { return inertia(shape); }, body.shape());
  return (vectorOf(body.linearVelocity()).squaredNorm() + about.dot(turning.cwiseAbs2())) / 2;
}

/// FreeFall on an engine, with access to its bodies.
class FreeFallWorld {
 public:
  FreeFallWorld(const std::string& engine, const std::string& object_type, std::int64_t objects) {
    setting("engine", engine);
    setting("object_type", object_type);
    settings_.objects = objects;
    // The world must be large enough for the longest bar.
    if (object_type == "assorted") settings_.density = 0.01;
    engine_ = entryOf(engineEntries(), engine, "engine").create(settings_.physics);
    for (int axis = 0; axis < 3; ++axis) {
      for (const float sign : {1.0F, -1.0F}) {
        HalfSpace wall{.offset = static_cast<float>(-settings_.side() / 2)};
        wall.normal[axis] = sign;
        engine_->addWall(wall);
      }
    }
    const auto scene = entryOf(sceneEntries(), "freefall", "scene").create();
    const ObjectType type = entryOf(objectTypes(), object_type, "object type");
    Bodies bodies(*engine_, {.objects = static_cast<std::uint32_t>(objects)});
    Stage stage{settings_, type, *engine_, bodies, random_};
    scene->populate(stage);
    scene->start(stage);
    for (const std::uint32_t id : bodies.inEngine()) bodies_.push_back(bodies[id]);
  }

  void step() { engine_->step(); }

  [[nodiscard]] const std::vector<PhysicsBody*>& bodies() const { return bodies_; }

  /// The mean kinetic energy plus potential energy above the floor, per mass of a body.
  [[nodiscard]] double energy() const {
    const double gravity = settings_.gravity * settings_.side();
    double sum = 0;
    for (const PhysicsBody* body : bodies_) {
      sum += kineticEnergy(*body) + gravity * (body->pose().position[1] + settings_.side() / 2);
    }
    return sum / static_cast<double>(bodies_.size());
  }

  [[nodiscard]] std::size_t resting() const {
    return static_cast<std::size_t>(std::ranges::count_if(bodies_, [](const PhysicsBody* body) {
      return body->asleep() || kineticEnergy(*body) < 1e-6;
    }));
  }

  /// The maximum distance of a centre, or of any point, from the world; negative: inside.
  [[nodiscard]] double outside(bool centres) const {
    double farthest = -1e9;
    for (const PhysicsBody* body : bodies_) {
      const Pose pose = body->pose();
      const Aabb box = tightBox(body->shape(), pose);
      for (int axis = 0; axis < 3; ++axis) {
        const double point =
            centres ? std::abs(pose.position[axis]) : std::max(-box.min[axis], box.max[axis]);
        farthest = std::max(farthest, point - settings_.side() / 2);
      }
    }
    return farthest;
  }

  /// The maximum penetration depth of each body; negative: the distance to the nearest body. Walls
  /// count as bodies.
  [[nodiscard]] std::vector<double> depths() const {
    std::vector<double> deepest(bodies_.size(), -1e9);
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      const Aabb box = tightBox(bodies_[i]->shape(), bodies_[i]->pose());
      for (int axis = 0; axis < 3; ++axis) {
        deepest[i] = std::max({deepest[i], -box.min[axis] - settings_.side() / 2,
                               box.max[axis] - settings_.side() / 2});
      }
      for (std::size_t j = 0; j < i; ++j) {
        const Aabb other = tightBox(bodies_[j]->shape(), bodies_[j]->pose());
        if (!overlaps(enlarged(box, 0.1F), other)) continue;
        const double pair = depth(*bodies_[i], *bodies_[j]);
        deepest[i] = std::max(deepest[i], pair);
        deepest[j] = std::max(deepest[j], pair);
      }
    }
    return deepest;
  }

 private:
  void setting(const std::string& name, const std::string& value) {
    settings_.visit([&](const Parameter& parameter) {
      if (parameter.name == name) setParameter(parameter, value);
    });
  }

  Settings settings_;
  Random random_{1};
  std::unique_ptr<PhysicsEngine> engine_;
  std::vector<PhysicsBody*> bodies_;
};

using Case = std::tuple<std::string, std::string>;  // engine, object type

std::vector<std::string> enginesThat(Dynamics dynamics) {
  std::vector<std::string> ids;
  for (const EngineEntry& entry : engineEntries()) {
    if (entry.listing.dynamics == dynamics) ids.push_back(entry.listing.id);
  }
  return ids;
}

class Plausibility : public testing::TestWithParam<Case> {
 protected:
  /// Simulates frames, and expects that bodies gain no energy and lose much of it. Calls
  /// check(frame) after each.
  template <class FrameCheck>
  void expectLossOfEnergy(int frames, FrameCheck&& check) {
    const double start = world_.energy();
    double before = start;
    for (int frame = 1; frame <= frames; ++frame) {
      world_.step();
      const double now = world_.energy();
      EXPECT_LT(now, before + 1e-4 * start) << "frame " << frame;
      before = now;
      check(frame);
    }
    EXPECT_LT(before, 0.5 * start) << "inelastic impacts and friction take energy";
  }

  FreeFallWorld world_{std::get<0>(GetParam()), std::get<1>(GetParam()), 200};
};

/// Engines with collisions between bodies.
class RigidPlausibility : public Plausibility {};
/// Engines without collisions between bodies.
class PassingPlausibility : public Plausibility {};

// Measured with either engine: no gain; depth 0.02 of cubes and spheres, 0.06 of assorted bodies,
// which are as thin as 0.08 and start deep inside each other and the walls.
TEST_P(RigidPlausibility, BodiesGainNoEnergySinkInOrEscape) {
  const double allowed = std::get<1>(GetParam()) == "assorted" ? 0.1 : 0.05;
  constexpr int kUntangled = 20;  // frames until overlapping bodies are separated
  expectLossOfEnergy(120, [&](int frame) {
    EXPECT_LT(world_.outside(true), 0) << "frame " << frame << ": a centre is outside";
    if (frame <= kUntangled || frame % 10 != 0) return;
    EXPECT_LT(std::ranges::max(world_.depths()), allowed) << "frame " << frame;
  });
}

TEST_P(PassingPlausibility, BodiesGainNoEnergyAndStayInTheWorld) {
  expectLossOfEnergy(
      120, [&](int frame) { EXPECT_LT(world_.outside(false), 1e-5) << "frame " << frame; });
}

TEST_P(PassingPlausibility, AllBodiesComeToRest) {
  for (int frame = 0; frame < 1000; ++frame) world_.step();
  EXPECT_EQ(world_.resting(), 200U);
}

/// FreeFall until all bodies rest: takes seconds.
class RigidSettling : public RigidPlausibility {};

// Measured after 1,000 frames: all asleep, depth at most 0.009, gaps at most 0.006.
TEST_P(RigidSettling, AlmostAllBodiesRestOnSomething) {
  for (int frame = 0; frame < 1000; ++frame) world_.step();
  EXPECT_GE(world_.resting(), 198U) << "99 %";
  for (const double depth : world_.depths()) {
    EXPECT_LT(depth, 0.03) << "sunk in";
    EXPECT_GT(depth, -0.03) << "floats";
  }
}

// A pile as high as that of 32,000 cubes, under the gravity of their world, on a small floor. With
// bodies held by their velocity, three quarters of the pile moved in these frames, and it sank.
TEST(BulletPile, ComesToRestHoweverHighItIs) {
  const auto engine = entryOf(engineEntries(), "bullet", "engine").create(Settings().physics);
  constexpr Vec3 kHalfWorld = {3.5F, 24, 3.5F};
  for (int axis = 0; axis < 3; ++axis) {
    for (const float sign : {1.0F, -1.0F}) {
      HalfSpace wall{.offset = -kHalfWorld[axis]};
      wall.normal[axis] = sign;
      engine->addWall(wall);
    }
  }
  engine->setGravity({0, -6.7F, 0});
  constexpr int kBodies = 340;
  Random random{1};
  std::vector<PhysicsBody*> bodies;
  for (int i = 0; i < kBodies; ++i) {
    const auto side = [&] { return static_cast<float>(random.between(-2.5, 2.5)); };
    const Vec3 place = {side(), -23 + 46.0F * static_cast<float>(i) / kBodies, side()};
    bodies.push_back(
        &engine->addBody({.shape = BoxShape{{0.5F, 0.5F, 0.5F}}, .pose = {.position = place}}));
  }
  for (int frame = 0; frame < 550; ++frame) engine->step();
  std::vector<Pose> before;
  for (const PhysicsBody* body : bodies) before.push_back(body->pose());
  constexpr int kFrames = 20;
  int moves = 0;
  for (int frame = 0; frame < kFrames; ++frame) {
    engine->step();
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      moves += static_cast<int>(bodies[i]->pose() != before[i]);
      before[i] = bodies[i]->pose();
    }
  }
  EXPECT_LE(moves, kBodies * kFrames / 50) << "2 % of the bodies";
}

const auto name_of_case = [](const auto& param) {
  return std::get<0>(param.param) + "_" + std::get<1>(param.param);
};
INSTANTIATE_TEST_SUITE_P(All, RigidPlausibility,
                         testing::Combine(testing::ValuesIn(enginesThat(Dynamics::rigid)),
                                          testing::ValuesIn(idsOf(objectTypes()))),
                         name_of_case);
INSTANTIATE_TEST_SUITE_P(All, PassingPlausibility,
                         testing::Combine(testing::ValuesIn(enginesThat(Dynamics::passing)),
                                          testing::ValuesIn(idsOf(objectTypes()))),
                         name_of_case);
INSTANTIATE_TEST_SUITE_P(All, RigidSettling,
                         testing::Combine(testing::ValuesIn(enginesThat(Dynamics::rigid)),
                                          testing::Values("cubes")),
                         name_of_case);

}  // namespace
}  // namespace broadmark::scenes
