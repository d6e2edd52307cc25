// Worlds: many copies of a small FreeFall at the same place, as in robot learning: bodies collide
// only within a copy. Each copy restarts after an episode, one after the other.

#include <algorithm>
#include <cstdint>
#include <vector>

#include "broadmark/scenes/scene.h"
#include "entries.h"

namespace broadmark::scenes::worlds {
namespace {

class Worlds final : public Scene {
 public:
  void setDefaults(Settings& settings) const override {
    settings.density = 0.05;
    settings.gravity = 0.5;
  }

  void visitParameters(const ParameterVisitor& visit) override {
    visit({"bodies_per_world", "number of bodies in each copy; the density is that of one copy",
           &bodies_per_world_, 1, 1'000'000});
    visit({"episode", "frames after which a copy restarts", &episode_, 1, 1'000'000});
  }

  void describe(const Settings& settings, SceneInfo& info) const override {
    info.world = copySettings(settings).world();
    std::vector<BodyGroups> bodies(info.objects);
    for (std::size_t id = 0; id < bodies.size(); ++id) {
      bodies[id].world =
          static_cast<std::uint32_t>(id / static_cast<std::size_t>(bodies_per_world_));
    }
    info.filter = {bodies, LayerMatrix().set(0, 0)};
  }

  void prepare(const Settings& settings, Random&) override {
    starts_.clear();
    starts_.reserve(static_cast<std::size_t>(settings.objects));
    world_size_ = static_cast<std::size_t>(bodies_per_world_);
    copy_settings_ = copySettings(settings);
  }

  void place(std::size_t index, BodyDescription& body, const Settings&, Random& random) override {
    Scene::place(index, body, copy_settings_, random);
    starts_.push_back(body);
  }

  void start(Stage& stage) override {
    stage.engine.setGravity(
        {0, -static_cast<float>(copy_settings_.gravity * copy_settings_.side()), 0});
  }

  void act(Stage& stage, std::uint32_t frame) override {
    const std::size_t worlds = (starts_.size() + world_size_ - 1) / world_size_;
    const auto episode = static_cast<std::size_t>(episode_);
    for (std::size_t world = 0; world < worlds; ++world) {
      // Episodes end one after the other.
      if ((frame + world * episode / worlds) % episode == 0) restart(world, stage);
    }
  }

 private:
  /// The settings of a copy as a separate scene.
  [[nodiscard]] Settings copySettings(const Settings& settings) const {
    Settings copy = settings;
    copy.objects = std::min(bodies_per_world_, settings.objects);
    return copy;
  }

  void restart(std::size_t world, Stage& stage) const {
    const std::size_t end = std::min(starts_.size(), (world + 1) * world_size_);
    for (std::size_t id = world * world_size_; id < end; ++id) {
      PhysicsBody& body = *stage.bodies[id];
      body.setPose(starts_[id].pose);
      body.setVelocity(starts_[id].linear_velocity, starts_[id].angular_velocity);
    }
  }

  std::int64_t bodies_per_world_ = 20;
  std::int64_t episode_ = 100;
  std::size_t world_size_ = 1;
  Settings copy_settings_;               ///< of a copy
  std::vector<BodyDescription> starts_;  ///< by body
};

}  // namespace

SceneEntry entry() {
  return {{"worlds", "Worlds", "many copies of a small FreeFall at the same place"},
          makeEntry<Scene, Worlds>};
}

}  // namespace broadmark::scenes::worlds
