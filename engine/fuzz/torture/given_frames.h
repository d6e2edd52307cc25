// Synthetic frames, not from a recording.
#pragma once

#include <utility>
#include <vector>

#include "broadmark/frame.h"

namespace broadmark::inputs {

/// The header for a recording of these frames; its world contains all boxes.
inline SceneInfo sceneOf(const std::vector<std::vector<Aabb>>& frames) {
  SceneInfo scene;
  scene.name = "Test";
  scene.object_type = "Boxes";
  scene.objects = static_cast<std::uint32_t>(frames.front().size());
  scene.frames = static_cast<std::uint32_t>(frames.size() - 1);
  scene.world = {{-1, -1, -1, 0}, {1, 1, 1, 0}};
  for (const std::vector<Aabb>& boxes : frames) {
    for (const Aabb& box : boxes) scene.world = merged(scene.world, box);  // may be an empty box
  }
  return scene;
}

/// A scene with at least one given frame.
class GivenFrames final : public IndexedFrames {
 public:
  /// `filters`: that of each frame, if they change.
  GivenFrames(SceneInfo scene, std::vector<std::vector<Aabb>> frames,
              std::vector<CollisionFilter> filters = {})
      : scene_(std::move(scene)), frames_(std::move(frames)), filters_(std::move(filters)) {
    scene_.filter_changes = !filters_.empty();
    if (scene_.filter_changes) scene_.filter = filters_.front();
    scene_.objects = static_cast<std::uint32_t>(frames_.front().size());
    scene_.frames = static_cast<std::uint32_t>(frames_.size()) - 1;
  }

  [[nodiscard]] const SceneInfo& scene() const override { return scene_; }

 private:
  std::span<const Aabb> readBoxes(std::uint32_t index) override {
    last_ = index;
    return frames_[index];
  }
  [[nodiscard]] const CollisionFilter* filter() const override {
    return filters_.empty() ? nullptr : &filters_[last_];
  }

  SceneInfo scene_;
  std::vector<std::vector<Aabb>> frames_;
  std::vector<CollisionFilter> filters_;
  std::uint32_t last_ = 0;  ///< frame
};

}  // namespace broadmark::inputs
