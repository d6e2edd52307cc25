// A part of a recording: a subset of bodies and frames, fewer absences, a simpler filter.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "broadmark/frame.h"
#include "broadmark/large_array.h"

namespace broadmark {

/// A box for a body in frames in which it is absent in the recording.
struct Filling {
  std::uint32_t body = 0;
  std::uint32_t first = 0;  ///< frame
  std::uint32_t last = 0;   ///< frame, inclusive
  Aabb box;

  friend bool operator==(const Filling&, const Filling&) = default;
};

/// A selection of bodies and frames, with simplifications. Bodies and frames keep their order and
/// are renumbered from 0.
struct Selection {
  std::vector<std::uint32_t> bodies;  ///< ascending
  std::vector<std::uint32_t> frames;  ///< ascending; the first becomes the initial pose
  std::vector<Filling> filled = {};   ///< with the recording's ids
  bool all_present = true;            ///< SceneInfo::all_present of the part
  CollisionFilter filter = {};        ///< the filter of `bodies`, in their order
  /// Bodies with the recording's ids, ascending, that have its layers and tags in each frame
  /// instead of the filter's.
  std::vector<std::uint32_t> filter_changes = {};

  friend bool operator==(const Selection&, const Selection&) = default;
};

/// Selects these bodies and frames, unchanged. Both lists are ascending.
Selection selectionOf(const SceneInfo&, std::vector<std::uint32_t> bodies,
                      std::vector<std::uint32_t> frames);
/// All bodies in frames 0…last.
Selection selectAll(const SceneInfo&, std::uint32_t last_frame);

/// The selected part as a source, with the same world and the given name.
class SubRecording final : public IndexedFrames {
 public:
  /// `whole` must outlive this, and contain the selected ids.
  SubRecording(IndexedFrames& whole, Selection part, std::string name);

  [[nodiscard]] const SceneInfo& scene() const override { return scene_; }

 private:
  std::span<const Aabb> readBoxes(std::uint32_t index) override;
  [[nodiscard]] const CollisionFilter* filter() const override {
    return scene_.filter_changes ? &filter_ : nullptr;
  }
  [[nodiscard]] CollisionFilter filterFrom(const Frame& frame) const;

  IndexedFrames& whole_;
  Selection part_;
  SceneInfo scene_;
  LargeVector<Aabb> boxes_;
  // If filters change.
  CollisionFilter filter_;        ///< of the last frame
  CollisionFilter whole_filter_;  ///< the recording's in that frame
  bool has_filter_ = false;       ///< a frame has been read
};

/// The name of a part of a scene: "FreeFall case".
std::string partName(const SceneInfo&);

/// Writes the selected part of `whole` as a recording of boxes in the format of the path's
/// extension. Returns its hash. Throws InputError, also if the format cannot hold the part.
std::string writeSelection(const std::filesystem::path& path, IndexedFrames& whole,
                           const Selection&);

}  // namespace broadmark
