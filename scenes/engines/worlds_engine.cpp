// An engine for each world. One engine for all would have to look at every pair of bodies at the
// same place, only to find that nearly all are in different worlds.

#include "engines/worlds_engine.h"

#include <algorithm>
#include <map>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

namespace broadmark::scenes {
namespace {

class WorldsEngine final : public PhysicsEngine {
 public:
  explicit WorldsEngine(EngineMaker make_engine) : make_engine_(std::move(make_engine)) {}

  void setLayers(const LayerMatrix& layers) override { layers_ = layers; }

  PhysicsBody& addBody(const BodyDescription& description) override {
    PhysicsEngine& world = worldOf(description.world);
    PhysicsBody& body = world.addBody(description);
    world_of_body_[&body] = &world;
    return body;
  }

  void removeBody(PhysicsBody& body) override {
    const auto found = world_of_body_.find(&body);
    found->second->removeBody(body);
    world_of_body_.erase(found);
  }

  void addWall(const HalfSpace& wall) override {
    walls_.push_back(wall);
    for (auto& [number, world] : worlds_) world->addWall(wall);
  }

  void setGravity(const Vec3& gravity) override {
    gravity_ = gravity;
    for (auto& [number, world] : worlds_) world->setGravity(gravity);
  }
  [[nodiscard]] Vec3 gravity() const override { return gravity_; }

  void step() override {
    for (auto& [number, world] : worlds_) {
      if (!world->allAsleep()) world->step();
    }
  }

  [[nodiscard]] bool allAsleep() const override {
    return std::ranges::all_of(worlds_,
                               [](const auto& world) { return world.second->allAsleep(); });
  }

 private:
  PhysicsEngine& worldOf(std::uint32_t number) {
    auto& world = worlds_[number];
    if (!world) {
      world = make_engine_();
      if (layers_) world->setLayers(*layers_);
      for (const HalfSpace& wall : walls_) world->addWall(wall);
      world->setGravity(gravity_);
    }
    return *world;
  }

  EngineMaker make_engine_;
  std::optional<LayerMatrix> layers_;
  std::vector<HalfSpace> walls_;
  Vec3 gravity_{};
  std::map<std::uint32_t, std::unique_ptr<PhysicsEngine>> worlds_;  ///< by number
  std::unordered_map<const PhysicsBody*, PhysicsEngine*> world_of_body_;
};

}  // namespace

std::unique_ptr<PhysicsEngine> makeWorlds(EngineMaker make_engine) {
  return std::make_unique<WorldsEngine>(std::move(make_engine));
}

}  // namespace broadmark::scenes
