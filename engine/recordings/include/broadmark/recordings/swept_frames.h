// Swept boxes, as used in continuous collision detection.
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

/// The smallest box around `now` and `before`, with each bound moved outward by one unit in the
/// last place. kEmptyBox if `now` is absent; `before` is ignored if absent.
Aabb sweptBox(const Aabb& before, const Aabb& now);

/// Suffix of the name of a scene with swept boxes.
inline constexpr std::string_view kSweptSuffix = " swept";
/// The scene with swept boxes: "FreeFall swept".
SceneInfo sweptScene(SceneInfo);

/// A source with swept boxes: each box also contains the body's box in the frame
/// before. In the initial pose boxes are only rounded outward.
class SweptFrames final : public IndexedFrames {
 public:
  explicit SweptFrames(std::unique_ptr<IndexedFrames> frames);

  [[nodiscard]] const SceneInfo& scene() const override { return scene_; }
  [[nodiscard]] const std::string& name() const override { return frames_->name(); }

 private:
  std::span<const Aabb> readBoxes(std::uint32_t index) override;
  [[nodiscard]] std::optional<std::span<const std::uint32_t>> changed() const override;
  [[nodiscard]] const CollisionFilter* filter() const override { return filter_; }
  [[nodiscard]] std::span<const std::uint32_t> filterChanged() const override {
    return filter_changed_;
  }
  /// Starts with frame `index`, with boxes not swept yet.
  void begin(std::uint32_t index);
  /// Advances to frame `index`, the successor of `last_`.
  void advance(std::uint32_t index);
  /// The bodies with swept boxes that may differ from the last frame's.
  std::span<const std::uint32_t> candidates(std::span<const std::uint32_t> changed);

  std::unique_ptr<IndexedFrames> frames_;
  SceneInfo scene_;
  std::optional<std::uint32_t> last_;  ///< the frame of the following members, if any
  std::vector<Aabb> before_;           ///< boxes of frames_
  LargeVector<Aabb> boxes_;            ///< swept
  bool reports_changes_ = false;
  std::vector<std::uint32_t> moved_;       ///< bodies that changed in frames_
  std::vector<std::uint32_t> candidates_;  ///< bodies that changed in this frame or the one before
  std::vector<std::uint32_t> changed_;     ///< bodies with changed swept boxes
  // As in frames_, until its next frame.
  const CollisionFilter* filter_ = nullptr;
  std::span<const std::uint32_t> filter_changed_;
};

}  // namespace broadmark
