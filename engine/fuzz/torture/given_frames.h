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
  GivenFrames(SceneInfo scene, std::vector<std::vector<Aabb>> frames)
      : scene_(std::move(scene)), frames_(std::move(frames)) {
    scene_.objects = static_cast<std::uint32_t>(frames_.front().size());
    scene_.frames = static_cast<std::uint32_t>(frames_.size()) - 1;
  }

  [[nodiscard]] const SceneInfo& scene() const override { return scene_; }

 private:
  std::span<const Aabb> readBoxes(std::uint32_t index) override { return frames_[index]; }

  SceneInfo scene_;
  std::vector<std::vector<Aabb>> frames_;
};

}  // namespace broadmark::inputs
