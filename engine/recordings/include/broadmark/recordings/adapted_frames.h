// Reading options that change the boxes of any source: the list of frame adapters.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "broadmark/frame.h"
#include "broadmark/large_array.h"
#include "broadmark/parameters.h"

namespace broadmark {

/// Base of the adapters: the frames of a source with other boxes, or in another order. Bodies keep
/// their filters.
class AdaptedFrames : public IndexedFrames {
 public:
  [[nodiscard]] const SceneInfo& scene() const final { return scene_; }
  [[nodiscard]] const std::string& name() const final { return frames_->name(); }

 protected:
  explicit AdaptedFrames(std::unique_ptr<IndexedFrames> frames)
      : scene_(frames->scene()), boxes_(scene_.objects), frames_(std::move(frames)) {}

  /// Reads a frame of the source, and takes its filter.
  Frame readSource(std::uint32_t index);

  SceneInfo scene_;                     ///< the source's, until the adapter changes it
  std::optional<std::uint32_t> last_;   ///< the frame of boxes_ and changed_, if any
  LargeVector<Aabb> boxes_;             ///< adapted
  bool reports_changes_ = false;        ///< the source lists its changes, and so does the adapter
  std::vector<std::uint32_t> changed_;  ///< bodies with other adapted boxes than a frame before
  // As in the source, until its next frame.
  const CollisionFilter* filter_ = nullptr;
  std::span<const std::uint32_t> filter_changed_;

 private:
  [[nodiscard]] std::optional<std::span<const std::uint32_t>> changed() const final;
  [[nodiscard]] const CollisionFilter* filter() const final { return filter_; }
  [[nodiscard]] std::span<const std::uint32_t> filterChanged() const final {
    return filter_changed_;
  }

  std::unique_ptr<IndexedFrames> frames_;
};

// `reading`: reading options that are not at their defaults, as in results. Each adapter is named
// after its option, and they apply in the order of the list in adapted_frames.cpp: "swept",
// "widen", "periodic", "body_order". Other options are ignored. Boxes of a source that is periodic
// are wrapped in any case.

/// The options among these that change boxes.
ParameterValues adaptersIn(ParameterValues reading);

/// A source with adapted boxes; without such options the source itself. Throws InputError for an
/// invalid value.
std::unique_ptr<IndexedFrames> adapted(std::unique_ptr<IndexedFrames> frames,
                                       const ParameterValues& reading);

/// The scene of the adapted frames of this scene: "FreeFall swept", "FreeFall swept widened".
/// Throws InputError for an invalid value.
SceneInfo adaptedScene(SceneInfo scene, const ParameterValues& reading);
/// The name of the original scene, from that of an adapted one.
std::string unadaptedName(std::string name, const ParameterValues& reading);

/// The hash of a recording's adapted boxes; `hash` is the recording's own.
std::string adaptedHash(std::string hash, const ParameterValues& reading);

}  // namespace broadmark
