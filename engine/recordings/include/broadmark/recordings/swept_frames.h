// Swept boxes, as used in continuous collision detection.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "broadmark/frame.h"
#include "broadmark/recordings/adapted_frames.h"

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
class SweptFrames final : public AdaptedFrames {
 public:
  explicit SweptFrames(std::unique_ptr<IndexedFrames> frames);

 private:
  std::span<const Aabb> readBoxes(std::uint32_t index) override;
  /// Starts with frame `index`, with boxes not swept yet.
  void begin(std::uint32_t index);
  /// Advances to frame `index`, the successor of `last_`.
  void advance(std::uint32_t index);
  /// The bodies with swept boxes that may differ from the last frame's.
  std::span<const std::uint32_t> candidates(std::span<const std::uint32_t> changed);

  // Of the frame `last_`.
  std::vector<Aabb> before_;               ///< boxes of the source
  std::vector<std::uint32_t> moved_;       ///< bodies that changed in the source
  std::vector<std::uint32_t> candidates_;  ///< bodies that changed in this frame or the one before
};

}  // namespace broadmark
