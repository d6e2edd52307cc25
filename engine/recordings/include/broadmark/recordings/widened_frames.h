// Boxes grown on every side, for pairs that are closer than a distance.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "broadmark/frame.h"
#include "broadmark/large_array.h"

namespace broadmark {

/// The smallest box of floats around `box` grown by half of `distance` on every side; kEmptyBox if
/// absent. Bounds beyond the largest float are the largest float, which changes no pair. Two such
/// boxes overlap if the gap between the original ones is at most `distance` on every axis; beyond
/// it only if the gap is larger by no more than the rounding of the bounds. `distance` >= 0.
Aabb widenedBox(const Aabb& box, double distance);

/// The largest distance: far beyond any world, and far from overflow.
inline constexpr double kMaxWidening = 1e30;

/// Suffix of the name of a scene with widened boxes.
inline constexpr std::string_view kWidenedSuffix = " widened";
/// The scene with widened boxes: "FreeFall widened", with its world widened alike.
SceneInfo widenedScene(SceneInfo, double distance);

/// A source with widened boxes.
class WidenedFrames final : public IndexedFrames {
 public:
  WidenedFrames(std::unique_ptr<IndexedFrames> frames, double distance);

  [[nodiscard]] const SceneInfo& scene() const override { return scene_; }
  [[nodiscard]] const std::string& name() const override { return frames_->name(); }

 private:
  std::span<const Aabb> readBoxes(std::uint32_t index) override;
  [[nodiscard]] std::optional<std::span<const std::uint32_t>> changed() const override;
  [[nodiscard]] const CollisionFilter* filter() const override { return filter_; }
  [[nodiscard]] std::span<const std::uint32_t> filterChanged() const override {
    return filter_changed_;
  }
  void widenAll(const Frame& frame);

  std::unique_ptr<IndexedFrames> frames_;
  double distance_;
  SceneInfo scene_;
  std::optional<std::uint32_t> last_;  ///< the frame of boxes_, if any
  LargeVector<Aabb> boxes_;            ///< widened
  bool reports_changes_ = false;
  std::vector<std::uint32_t> changed_;  ///< bodies with changed widened boxes
  // As in frames_, until its next frame.
  const CollisionFilter* filter_ = nullptr;
  std::span<const std::uint32_t> filter_changed_;
};

}  // namespace broadmark
