// Streaming: a level of static boxes, of which the tiles around a viewer are loaded ahead of it and
// unloaded behind it, while the viewer moves along a circle. A few bodies fly through the whole
// level. With a single tile all of the level is loaded at the start, at once or in batches. Two
// layers: static boxes do not collide with each other.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "broadmark/scenes/scene.h"
#include "broadmark/scenes/simulation.h"
#include "entries.h"
#include "scenes/course.h"

namespace broadmark::scenes::streaming {
namespace {

class Streaming final : public Scene {
 public:
  void setDefaults(Settings& settings) const override {
    setFreeFlight(settings);
    settings.density = 0.02;
    settings.initial_speed = 0.1;
    settings.physics.substeps = 1;
  }

  void visitParameters(const ParameterVisitor& visit) override {
    visit({"tiles", "tiles of the level along each horizontal side", &tiles_, 1, 1000});
    visit({"view", "tiles loaded in each direction around the viewer's tile", &view_, 0, 1000});
    visit({"batches", "frames over which a tile is loaded", &batches_, 1, 1'000'000});
    visit({"period", "frames of the viewer's round", &period_, 1, 1'000'000});
    visit({"movers", "share of the bodies that fly about", &movers_, 0, 1});
  }

  void describe(const Settings&, SceneInfo& info) const override {
    info.all_present = false;
    std::vector<BodyGroups> bodies(info.objects);
    for (std::size_t id = moverCount(bodies.size()); id-- > 0;) bodies[id].layer = 1;
    info.filter = {bodies, LayerMatrix().set(0, 1).set(1, 1)};
  }

  void populate(Stage& stage) override {
    constexpr double kMaxSize = 8;
    const std::size_t movers = moverCount(stage.bodies.size());
    for (std::size_t id = 0; id < movers; ++id) {
      BodyDescription body = stage.describeAnywhere(id);
      body.linear_velocity = launchVelocity(stage.settings, stage.random);
      stage.bodies.add(id, body);
    }
    level_.assign(static_cast<std::size_t>(tiles_ * tiles_), {});
    for (std::size_t id = movers; id < stage.bodies.size(); ++id) {
      const double size = powerLawSize(kMaxSize, stage.random);
      const BodyDescription body = stage.describeAnywhere(id, size);
      const Tile tile = tileAt(body.pose.position[0], body.pose.position[2], stage.settings);
      level_[indexOf(tile)].boxes.push_back({id, body.shape, body.pose});
    }
  }

  void act(Stage& stage, std::uint32_t frame) override {
    const Tile viewer = viewerIn(frame, stage.settings);
    for (Tile tile = {0, 0}; tile.z < tiles_; tile = next(tile)) {
      LevelTile& part = level_[indexOf(tile)];
      const bool is_near =
          std::max(std::abs(tile.x - viewer.x), std::abs(tile.z - viewer.z)) <= view_;
      if (is_near) {
        load(part, stage.bodies);
      } else {
        unload(part, stage.bodies);
      }
    }
  }

 private:
  struct Tile {
    std::int64_t x;
    std::int64_t z;
  };
  struct StaticBox {
    std::size_t id;
    Shape shape;
    Pose pose;
  };
  struct LevelTile {
    std::vector<StaticBox> boxes;
    std::size_t loaded = 0;  ///< the first ones
  };

  void load(LevelTile& part, Bodies& bodies) const {
    const auto batches = static_cast<std::size_t>(batches_);
    const std::size_t batch = (part.boxes.size() + batches - 1) / batches;
    const std::size_t end = std::min(part.loaded + batch, part.boxes.size());
    for (; part.loaded < end; ++part.loaded) {
      const StaticBox& box = part.boxes[part.loaded];
      bodies.place(box.id, box.shape, box.pose);
    }
  }

  static void unload(LevelTile& part, Bodies& bodies) {
    for (; part.loaded > 0; --part.loaded) bodies.remove(part.boxes[part.loaded - 1].id);
  }

  [[nodiscard]] std::size_t moverCount(std::size_t count) const {
    return static_cast<std::size_t>(movers_ * static_cast<double>(count));
  }

  [[nodiscard]] Tile viewerIn(std::uint32_t frame, const Settings& settings) const {
    const double angle = 2 * std::numbers::pi * frame / static_cast<double>(period_);
    const double radius = settings.side() / 4;
    return tileAt(radius * std::cos(angle), radius * std::sin(angle), settings);
  }
  [[nodiscard]] Tile tileAt(double x, double z, const Settings& settings) const {
    const auto along = [&](double position) {
      const double share = position / settings.side() + 0.5;
      const auto tile = static_cast<std::int64_t>(share * static_cast<double>(tiles_));
      return std::clamp<std::int64_t>(tile, 0, tiles_ - 1);
    };
    return {along(x), along(z)};
  }
  [[nodiscard]] std::size_t indexOf(Tile tile) const {
    return static_cast<std::size_t>(tile.z * tiles_ + tile.x);
  }
  [[nodiscard]] Tile next(Tile tile) const {
    return tile.x + 1 < tiles_ ? Tile{tile.x + 1, tile.z} : Tile{0, tile.z + 1};
  }

  std::int64_t tiles_ = 8;
  std::int64_t view_ = 2;
  std::int64_t batches_ = 4;
  std::int64_t period_ = 400;
  double movers_ = 0.02;
  std::vector<LevelTile> level_;
};

}  // namespace

SceneEntry entry() {
  return {{"streaming", "Streaming", "a level, loaded and unloaded by tiles around a viewer"},
          makeEntry<Scene, Streaming>};
}

}  // namespace broadmark::scenes::streaming
