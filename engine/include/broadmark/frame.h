// What an algorithm gets to see: a scene, frame after frame.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "broadmark/aabb.h"

namespace broadmark {

/// What is known of a scene before its first frame: a recording's header.
struct SceneInfo {
  std::string name;         ///< "FreeFall"; printable ASCII, at most 127 characters
  std::string object_type;  ///< "Cubes"; likewise
  std::uint32_t objects = 0;
  std::uint32_t frames = 0;  ///< the initial pose not counted
  Aabb world;                ///< bodies may poke out a little

  friend bool operator==(const SceneInfo&, const SceneInfo&) = default;
};

/// The boxes of one moment. Body id = position. Borrowed: valid until the next call to whoever
/// handed the frame out.
struct Frame {
  std::uint32_t index = 0;  ///< 0 is the initial pose, 1…F are the frames that count
  std::span<const Aabb> boxes;
};

/// Where frames come from: a recording read ahead, or a live simulation. Runner and inspector do
/// not know which.
class FrameSource {
 public:
  virtual ~FrameSource() = default;

  [[nodiscard]] virtual const SceneInfo& scene() const = 0;

  /// Starts over and returns the initial pose (index 0).
  virtual Frame rewind() = 0;

  /// The next frame, wholly in resident memory, or nothing after the last one.
  virtual std::optional<Frame> next() = 0;
};

}  // namespace broadmark
