// A part of a recording: a subset of bodies and frames, fewer absences, a simpler filter.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "broadmark/frame.h"
#include "broadmark/large_array.h"

namespace broadmark {

/// Presence of a body while it is absent in the recording.
struct Filling {
  std::uint32_t body = 0;
  std::uint32_t first = 0;  ///< frame
  std::uint32_t last = 0;   ///< frame, inclusive
  Aabb box;                 ///< its box in these frames

  friend bool operator==(const Filling&, const Filling&) = default;
};

/// A selection of bodies and frames, with simplifications. Bodies and frames keep their order and
/// are renumbered from 0.
struct Part {
  std::vector<std::uint32_t> bodies;  ///< ascending
  std::vector<std::uint32_t> frames;  ///< ascending; the first becomes the initial pose
  std::vector<Filling> filled = {};   ///< with the recording's ids
  bool all_present = true;            ///< SceneInfo::all_present of the part
  CollisionFilter filter = {};        ///< of these bodies, in this order

  friend bool operator==(const Part&, const Part&) = default;
};

/// Selects these bodies and frames, unchanged.
Part partOf(const SceneInfo&, std::vector<std::uint32_t> bodies, std::vector<std::uint32_t> frames);
/// All bodies in frames 0…last.
Part wholePart(const SceneInfo&, std::uint32_t last_frame);

/// The selected part as a source: same world, the given name.
class SubRecording final : public IndexedFrames {
 public:
  /// `whole` outlives this and contains the part's ids.
  SubRecording(IndexedFrames& whole, Part part, std::string name);

  [[nodiscard]] const SceneInfo& scene() const override { return scene_; }

 private:
  std::span<const Aabb> readBoxes(std::uint32_t index) override;

  IndexedFrames& whole_;
  Part part_;
  SceneInfo scene_;
  LargeVector<Aabb> boxes_;
};

/// The name of a part of a scene: "FreeFall case".
std::string partName(const SceneInfo&);

/// Writes the selected part of `whole` as a recording of boxes in the format of the path's
/// extension. Returns its hash. Throws InputError, also if the format cannot hold the part.
std::string writePart(const std::filesystem::path& path, IndexedFrames& whole, const Part&);

}  // namespace broadmark
