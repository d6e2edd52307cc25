// A part of a recording: some bodies, some frames, fewer who come and go, a simpler filter.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "broadmark/frame.h"
#include "broadmark/large_array.h"

namespace broadmark {

/// A body that is there where it is absent in the recording.
struct Filling {
  std::uint32_t body = 0;
  std::uint32_t first = 0;  ///< frame
  std::uint32_t last = 0;   ///< frame, inclusive
  Aabb box;                 ///< where it is meanwhile

  friend bool operator==(const Filling&, const Filling&) = default;
};

/// Which bodies and frames, and what is simpler about them. Bodies and frames keep their order and
/// get new numbers, from 0.
struct Part {
  std::vector<std::uint32_t> bodies;  ///< ascending
  std::vector<std::uint32_t> frames;  ///< ascending; the first becomes the initial pose
  std::vector<Filling> filled = {};   ///< in the recording's numbers
  bool all_present = true;            ///< SceneInfo::all_present of the part
  CollisionFilter filter = {};        ///< of these bodies, in this order

  friend bool operator==(const Part&, const Part&) = default;
};

/// These bodies and frames, as they are in the scene.
Part partOf(const SceneInfo&, std::vector<std::uint32_t> bodies, std::vector<std::uint32_t> frames);
/// All bodies in frames 0…last.
Part wholePart(const SceneInfo&, std::uint32_t last_frame);

/// The selected part as a source: same world, the given name.
class SubRecording final : public IndexedFrames {
 public:
  /// `whole` outlives this; the part's numbers exist in it.
  SubRecording(IndexedFrames& whole, Part part, std::string name);

  [[nodiscard]] const SceneInfo& scene() const override { return scene_; }

 private:
  std::span<const Aabb> readBoxes(std::uint32_t index) override;

  IndexedFrames& whole_;
  Part part_;
  SceneInfo scene_;
  LargeVector<Aabb> boxes_;
};

/// What a part of a scene is called: "FreeFall case".
std::string partName(const SceneInfo&);

/// Writes the selected part of `whole` as a recording of boxes of the kind that the path's
/// extension names. Returns its hash. Throws InputError, too, when such a one cannot hold the part.
std::string writePart(const std::filesystem::path& path, IndexedFrames& whole, const Part&);

}  // namespace broadmark
