// Shooter: a level of boxes of all sizes that never move, characters that walk about in it, bursts
// of short-lived projectiles, and trigger volumes. Four layers: characters collide with all;
// projectiles with the level and characters; the level not with itself, and triggers only with
// characters. Triggers push nothing: they are scenery. At first projectiles are in a fifth layer,
// which collides with the level alone: until they have left the character that shot them.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <deque>
#include <numbers>
#include <vector>

#include "broadmark/scenes/scene.h"
#include "entries.h"
#include "scenes/course.h"
#include "scenes/lifetimes.h"

namespace broadmark::scenes::shooter {
namespace {

enum Layer : std::uint8_t { level, character, projectile, trigger, unarmed };

LayerMatrix collisions(bool has_unarmed) {
  return LayerMatrix()
      .set(level, character)
      .set(level, projectile)
      .set(character, character)
      .set(character, projectile)
      .set(character, trigger)
      .set(level, unarmed, has_unarmed);
}

/// The ends of the id ranges: level, then characters, triggers, projectiles.
struct Ends {
  std::size_t level = 0;
  std::size_t characters = 0;
  std::size_t triggers = 0;

  [[nodiscard]] Layer layerOf(std::size_t id) const {
    if (id < level) return Layer::level;
    if (id < characters) return Layer::character;
    return id < triggers ? Layer::trigger : Layer::projectile;
  }
};

class Shooter final : public Scene {
 public:
  void setDefaults(Settings& settings) const override {
    settings.density = 0.02;
    settings.initial_speed = 0.15;
    settings.gravity = 0.3;
  }

  void visitParameters(const ParameterVisitor& visit) override {
    visit({"level", "share of the ids that are boxes of the level", &level_, 0, 1});
    visit({"characters", "share that are characters, which walk at up to the initial speed",
           &characters_, 0, 1});
    visit({"triggers", "share that are trigger volumes; the rest is left to projectiles",
           &triggers_, 0, 1});
    visit({"largest", "longest edge of a box of the level, in sides of the world", &largest_, 1e-3,
           1});
    visit({"burst", "projectiles that a character shoots at once", &burst_, 0, 1'000'000});
    visit({"pause", "frames between two bursts of a character", &pause_, 1, 1'000'000});
    visit({"lifetime", "frames that a projectile lives", &lifetime_, 1, 1'000'000});
    visit({"arming",
           "frames until a projectile collides with characters, such as the one that shot it; 0: "
           "from the start",
           &arming_, 0, 1'000'000});
    visit({"muzzle_speed", "speed of a projectile, in sides of the world per second",
           &muzzle_speed_, 0, 10});
  }

  void describe(const Settings& settings, SceneInfo& info) const override {
    const Ends ends = endsOf(settings);
    std::vector<BodyGroups> bodies(info.objects);
    for (std::size_t id = 0; id < bodies.size(); ++id) bodies[id].layer = ends.layerOf(id);
    info.filter_changes = arming_ > 0;
    info.filter = {bodies, collisions(info.filter_changes), info.filter_changes};
    info.all_present = false;
  }

  void prepare(const Settings& settings, Random&) override {
    ends_ = endsOf(settings);
    lifetimes_.reset(ends_.triggers, static_cast<std::size_t>(settings.objects));
    headings_.assign(ends_.characters - ends_.level, {});
    unarmed_.clear();
  }

  void populate(Stage& stage) override {
    for (std::size_t id = 0; id < ends_.level; ++id) {
      stage.bodies.add(id, levelBox(id, stage)).freeze();
    }
    for (std::size_t id = ends_.level; id < ends_.characters; ++id) {
      BodyDescription body = stage.describeAnywhere(id);
      body.pose.position[1] = std::abs(body.pose.position[1]);  // they drop into the level
      stage.bodies.add(id, body);
    }
    for (std::size_t id = ends_.characters; id < ends_.triggers; ++id) {
      const BodyDescription body = stage.describeAnywhere(id, stage.random.between(2, 5));
      stage.bodies.place(id, body.shape, body.pose);
    }
  }

  void act(Stage& stage, std::uint32_t frame) override {
    lifetimes_.removeOld(stage.bodies, frame);
    armOld(stage.bodies, frame);
    for (std::size_t i = 0; i < headings_.size(); ++i) {
      // Staggered over the frames.
      const std::uint64_t turn = (frame + i) % static_cast<std::uint64_t>(pause_);
      if (turn == 0 || frame == 1) headings_[i] = anyDirection(stage.random);
      walk(*stage.bodies[ends_.level + i], headings_[i], stage.settings);
      if (turn != 0) continue;
      for (std::int64_t k = 0; k < burst_; ++k) shoot(ends_.level + i, stage, frame);
    }
  }

 private:
  [[nodiscard]] Ends endsOf(const Settings& settings) const {
    const auto count = static_cast<double>(settings.objects);
    const auto end = [&](double so_far, double share) {
      return std::min(count, so_far + std::ceil(share * count - 1e-9));
    };
    // A single body is a character.
    const double level = std::min(end(0, level_), std::max(0.0, count - 1));
    const double characters = end(level, characters_);
    return {static_cast<std::size_t>(level), static_cast<std::size_t>(characters),
            static_cast<std::size_t>(end(characters, triggers_))};
  }

  static Vec3 anyDirection(Random& random) {
    const double angle = random.between(0, 2 * std::numbers::pi);
    return {static_cast<float>(std::cos(angle)), 0, static_cast<float>(std::sin(angle))};
  }

  [[nodiscard]] BodyDescription levelBox(std::size_t id, Stage& stage) const {
    const Settings& settings = stage.settings;
    const double max_size = largest_ * settings.side() / settings.scale;
    BodyDescription body = stage.describeAnywhere(id, powerLawSize(max_size, stage.random));
    // Half of the boxes stand on the floor.
    if (id % 2 == 0) body.pose.position[1] = -farthestInside(body.shape, settings.side());
    return body;
  }

  /// Walks upright; gravity acts as on any body.
  static void walk(PhysicsBody& body, const Vec3& heading, const Settings& settings) {
    const auto speed = static_cast<float>(settings.initial_speed * settings.side());
    body.setVelocity({speed * heading[0], body.linearVelocity()[1], speed * heading[2]}, {});
  }

  void shoot(std::size_t shooter, Stage& stage, std::uint32_t frame) {
    constexpr double kSize = 0.3;
    const auto id = lifetimes_.allocate(frame + static_cast<std::uint32_t>(lifetime_));
    if (!id) return;
    const Settings& settings = stage.settings;
    BodyDescription body = stage.describeAnywhere(*id, kSize);
    const float reach = farthestInside(body.shape, settings.side());
    const Vec3 heading = headings_[shooter - ends_.level];
    const Vec3 spread = stage.random.inBall(0.2);
    const Vec3 from = stage.bodies[shooter]->pose().position;
    const auto speed = static_cast<float>(muzzle_speed_ * settings.side());
    const auto arm = static_cast<float>(1.5 * settings.scale);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float direction = heading[axis] + spread[axis];
      body.pose.position[axis] = std::clamp(from[axis] + arm * direction, -reach, reach);
      body.linear_velocity[axis] = speed * direction;
    }
    stage.bodies.add(*id, body);
    if (arming_ == 0) return;
    stage.bodies.setLayer(*id, Layer::unarmed);
    unarmed_.push_back({frame + static_cast<std::uint32_t>(arming_), *id});
  }

  /// A later projectile may have the id by now: then it is unarmed, and follows in the queue.
  void armOld(Bodies& bodies, std::uint32_t frame) {
    for (; !unarmed_.empty() && unarmed_.front().until <= frame; unarmed_.pop_front()) {
      const std::size_t id = unarmed_.front().id;
      const bool is_reused =
          std::ranges::any_of(unarmed_.begin() + 1, unarmed_.end(),
                              [&](const Unarmed& other) { return other.id == id; });
      if (!is_reused) bodies.setLayer(id, Layer::projectile);
    }
  }

  struct Unarmed {
    std::uint32_t until = 0;  ///< frame
    std::size_t id = 0;
  };

  double level_ = 0.5;
  double characters_ = 0.02;
  double triggers_ = 0.05;
  double largest_ = 0.2;
  std::int64_t burst_ = 8;
  std::int64_t pause_ = 20;
  std::int64_t lifetime_ = 25;
  std::int64_t arming_ = 3;
  double muzzle_speed_ = 1.5;
  Ends ends_;
  Lifetimes lifetimes_;  ///< of projectiles
  std::deque<Unarmed> unarmed_;
  std::vector<Vec3> headings_;  ///< of characters
};

}  // namespace

SceneEntry entry() {
  return {{"shooter", "Shooter",
           "a level that never moves, characters, bursts of projectiles, triggers: five layers"},
          makeEntry<Scene, Shooter>};
}

}  // namespace broadmark::scenes::shooter
