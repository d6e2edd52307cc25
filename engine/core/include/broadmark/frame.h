// What an algorithm gets to see: a scene, frame after frame.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "broadmark/aabb.h"
#include "broadmark/collision_filter.h"
#include "broadmark/large_array.h"

namespace broadmark {

/// Longest name of a scene or an object type, in characters: what a recording's header holds.
inline constexpr std::size_t kLongestName = 127;

/// What is known of a scene before its first frame: a recording's header. A body's id is a slot
/// below `objects`; in each frame it is present or absent.
struct SceneInfo {
  std::string name;         ///< "FreeFall"; printable ASCII, at most kLongestName characters
  std::string object_type;  ///< "Cubes"; likewise
  std::uint32_t objects = 0;
  std::uint32_t frames = 0;  ///< the initial pose not counted
  Aabb world = {};           ///< bodies may poke out a little
  bool all_present = true;   ///< no body is ever absent
  CollisionFilter filter = {};

  friend bool operator==(const SceneInfo&, const SceneInfo&) = default;
};

/// The boxes of one moment. Borrowed: valid until the next call to the source of the frame.
struct Frame {
  std::uint32_t index = 0;      ///< 0 is the initial pose, 1…F are the frames that count
  std::span<const Aabb> boxes;  ///< by body id; kEmptyBox: absent
  /// The bodies that moved, appeared or vanished since frame `index` - 1, whichever frame was read
  /// last, ascending: those whose boxes differ by a bit. Nothing when the source does not know: an
  /// algorithm always gets them, found out before the clock starts. A source knows in all of its
  /// frames or in none; in frame 0 there are none.
  std::optional<std::span<const std::uint32_t>> changed = {};

  /// The ids of the bodies that are present, ascending.
  [[nodiscard]] std::vector<std::uint32_t> presentBodies() const;
};

/// Where frames come from, one after the other: a recording, or a live simulation. Who runs a case
/// does not know which.
class FrameSource {
 public:
  virtual ~FrameSource() = default;

  [[nodiscard]] virtual const SceneInfo& scene() const = 0;

  /// Starts over and returns the initial pose (index 0).
  virtual Frame rewind() = 0;

  /// The next frame, wholly in resident memory, or nothing after the last one.
  virtual std::optional<Frame> next() = 0;
};

/// Frames by their number, in any order: a recording, or frames held in memory.
class IndexedFrames : public FrameSource {
 public:
  /// Frame `index`, from 0, the initial pose, to scene().frames; next() goes on from there. Valid
  /// until the next call. Throws InputError when there is no such frame.
  Frame at(std::uint32_t index);

  Frame rewind() final { return at(0); }
  std::optional<Frame> next() final;

  /// What stands for it in messages.
  [[nodiscard]] virtual const std::string& name() const { return scene().name; }

 protected:
  /// The boxes of frame `index`, which exists.
  virtual std::span<const Aabb> readBoxes(std::uint32_t index) = 0;
  /// What changed in the frame that was read last, if this knows: Frame::changed.
  [[nodiscard]] virtual std::optional<std::span<const std::uint32_t>> changed() const { return {}; }

 private:
  std::uint32_t position_ = 0;
};

/// All frames of a source, held in memory: 32 · objects · (1 + frames) bytes.
class FrameList final : public IndexedFrames {
 public:
  explicit FrameList(FrameSource& source);

  [[nodiscard]] const SceneInfo& scene() const override { return scene_; }

 private:
  std::span<const Aabb> readBoxes(std::uint32_t index) override;

  SceneInfo scene_;
  LargeVector<Aabb> boxes_;
};

}  // namespace broadmark
