// A scene without physics: boxes that move in a room and are reflected by its walls.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "broadmark/frame.h"
#include "torture/inputs.h"

namespace broadmark::tests {

/// Unit boxes, a tenth of the room's volume, at up to 0.1 a frame along each axis. Same arguments,
/// same frames. A live source: frames are read in order only.
class WanderingBoxes final : public FrameSource {
 public:
  WanderingBoxes(std::uint32_t objects, std::uint32_t frames, std::uint64_t seed) : seed_(seed) {
    side_ = inputs::cubeRoot(10.0 * objects);
    scene_ = {"Wandering", "Cubes", objects, frames,
              inputs::boxAt({0, 0, 0}, {side_, side_, side_})};
  }

  [[nodiscard]] const SceneInfo& scene() const override { return scene_; }
  Frame rewind() override {
    inputs::Random random(seed_, 0);
    corners_.clear();
    velocities_.clear();
    for (std::uint32_t body = 0; body < scene_.objects; ++body) {
      corners_.push_back(random.inCube(side_ - 1));
      velocities_.push_back(random.inCube(0.2F));
      for (float& v : velocities_.back()) v -= 0.1F;
    }
    index_ = 0;
    return frame();
  }
  std::optional<Frame> next() override {
    if (index_ == scene_.frames) return std::nullopt;
    ++index_;
    for (std::size_t body = 0; body < corners_.size(); ++body) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        float& x = corners_[body][axis];
        float& v = velocities_[body][axis];
        x += v;
        if (x < 0 || x > side_ - 1) v = -v;
      }
    }
    return frame();
  }

 private:
  Frame frame() {
    boxes_.clear();
    for (const inputs::Vec3& corner : corners_) {
      boxes_.push_back(inputs::boxAt(corner, {1, 1, 1}));
    }
    return {index_, boxes_};
  }

  std::uint64_t seed_;
  float side_ = 0;
  SceneInfo scene_;
  std::uint32_t index_ = 0;
  std::vector<inputs::Vec3> corners_;
  std::vector<inputs::Vec3> velocities_;
  std::vector<Aabb> boxes_;
};

}  // namespace broadmark::tests
