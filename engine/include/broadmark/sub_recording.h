// A part of a recording: some bodies, some frames.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "broadmark/frame.h"

namespace broadmark {

/// Which bodies and frames. They keep their order and get new numbers, from 0.
struct Part {
  std::vector<std::uint32_t> bodies;  ///< ascending
  std::vector<std::uint32_t> frames;  ///< ascending; the first becomes the initial pose

  friend bool operator==(const Part&, const Part&) = default;
};

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
  std::vector<Aabb> boxes_;
};

/// What a part of a scene is called: "FreeFall case".
std::string partName(const SceneInfo&);

/// Writes the selected part of `whole` as an .aabbs recording. Returns its hash. Throws InputError.
std::string writePart(const std::filesystem::path& path, IndexedFrames& whole, const Part&);

}  // namespace broadmark
