// Swept boxes: what continuous collision detection feeds a broad phase.
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

/// The smallest box around `now` and `before`, each bound then moved outward by one unit in the
/// last place. Of an absent body: kEmptyBox if it is absent now; without `before` if it was absent
/// then.
Aabb sweptBox(const Aabb& before, const Aabb& now);

/// At the end of a scene's name: its boxes are swept.
inline constexpr std::string_view kSweptSuffix = " swept";
/// What a scene is called with swept boxes: "FreeFall swept".
std::string sweptName(const SceneInfo&);

/// The hash of a recording's swept boxes, of which the recording's own is `hash`.
std::string sweptHash(const std::string& hash);

/// The same bodies and frames with swept boxes: each body's box holds the one that it had in the
/// frame before, too. In the initial pose it is only rounded outward.
class SweptFrames final : public IndexedFrames {
 public:
  explicit SweptFrames(std::unique_ptr<IndexedFrames> frames);

  [[nodiscard]] const SceneInfo& scene() const override { return scene_; }
  [[nodiscard]] const std::string& name() const override { return frames_->name(); }

 private:
  std::span<const Aabb> readBoxes(std::uint32_t index) override;
  [[nodiscard]] std::optional<std::span<const std::uint32_t>> changed() const override;
  /// Starts with frame `index`, whose boxes are not swept yet.
  void begin(std::uint32_t index);
  /// Goes on to frame `index`, the one after the last.
  void advance(std::uint32_t index);
  /// Which bodies' swept boxes may be others than in the last frame.
  std::span<const std::uint32_t> candidates(std::span<const std::uint32_t> changed);

  std::unique_ptr<IndexedFrames> frames_;
  SceneInfo scene_;
  std::optional<std::uint32_t> last_;  ///< the frame that the following are of; nothing: none
  std::vector<Aabb> before_;           ///< as `frames_` has them
  LargeVector<Aabb> boxes_;            ///< swept
  bool knows_changed_ = false;
  std::vector<std::uint32_t> moved_;       ///< that changed in `frames_`
  std::vector<std::uint32_t> candidates_;  ///< that changed in it in this frame or the one before
  std::vector<std::uint32_t> changed_;     ///< whose swept boxes changed
};

}  // namespace broadmark
