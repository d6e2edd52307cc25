// The input of an algorithm: a scene, frame after frame.
//
// Example:
//
//   // All frames of a recording or live simulation, one after another.
//   const auto visit = [](FrameSource& source) {
//     const SceneInfo& scene = source.scene();
//     Frame frame = source.rewind();  // the initial pose, frame 0
//     while (const std::optional<Frame> next = source.next()) {
//       frame = *next;  // frame.boxes[body], until the next call
//     }
//     return frame.index == scene.frames;
//   };
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
#include "broadmark/periodic_box.h"

namespace broadmark {

/// Longest name of a scene or an object type, in characters: the capacity of a recording's header.
inline constexpr std::size_t kMaxNameLength = 127;

/// Properties of a scene before its first frame: a recording's header. A body's id is a slot below
/// `objects`; in each frame it is present or absent.
struct SceneInfo {
  std::string name;             ///< "FreeFall"; printable ASCII, at most kMaxNameLength characters
  std::string object_type;      ///< "Cubes"; with the same limits
  std::uint32_t objects = 0;    ///< the number of boxes in every frame, of absent bodies, too
  std::uint32_t frames = 0;     ///< without the initial pose
  Aabb world = {};              ///< in world units; bodies may protrude a little
  bool all_present = true;      ///< no body is ever absent
  CollisionFilter filter = {};  ///< of the initial pose, and of all frames unless filter_changes
  /// Layers and tags of bodies may change from frame to frame; their worlds and the matrix do not.
  bool filter_changes = false;
  /// If the world is periodic, all boxes are wrapped(), and bodies overlap if any of their images
  /// do.
  PeriodicBox periodic = {};

  friend bool operator==(const SceneInfo&, const SceneInfo&) = default;
};

/// The boxes of one moment. Borrowed: valid until the next call to the source of the frame.
struct Frame {
  std::uint32_t index = 0;      ///< 0 is the initial pose, 1…F are the frames that count
  std::span<const Aabb> boxes;  ///< by body id; kEmptyBox: absent
  /// The bodies that moved, appeared or vanished since frame `index` - 1 (not since the frame read
  /// last), ascending: their boxes differ bitwise. Empty in frame 0. nullopt if the source does not
  /// report changes, in all frames alike. Algorithms always get them, detected before the clock
  /// starts if necessary.
  std::optional<std::span<const std::uint32_t>> changed = {};
  /// The collision filter of this frame, only if SceneInfo::filter_changes; else null: the scene's.
  /// Borrowed, as the boxes.
  const CollisionFilter* filter = nullptr;
  /// The bodies with other layers or tags than in frame `index` - 1, ascending, whether present or
  /// not. Empty if the source does not report them. Algorithms always get them, as `changed`.
  std::span<const std::uint32_t> filter_changed = {};

  /// The collision filter of this frame, which is one of this scene: borrowed from either.
  [[nodiscard]] const CollisionFilter& filterIn(const SceneInfo& scene) const {
    return filter == nullptr ? scene.filter : *filter;
  }
  /// The ids of the bodies that are present, ascending. O(n); allocates.
  [[nodiscard]] std::vector<std::uint32_t> presentBodies() const;
};

/// A sequential source of frames: a recording, or a live simulation. The runner of a case does not
/// distinguish them. One thread at a time may use a source.
class FrameSource {
 public:
  virtual ~FrameSource() = default;

  /// The scene of all frames. Of a simulation, it may change at rewind(), when parameters take
  /// effect.
  [[nodiscard]] virtual const SceneInfo& scene() const = 0;

  /// Starts over and returns the initial pose (index 0). Throws InputError, as next() does, for
  /// what cannot be read, such as a damaged recording.
  virtual Frame rewind() = 0;

  /// The next frame, wholly in resident memory; nullopt after the last one.
  virtual std::optional<Frame> next() = 0;
};

/// Frames by index, in any order: a recording, or frames held in memory.
class IndexedFrames : public FrameSource {
 public:
  /// Frame `index`, from 0 (the initial pose) to scene().frames; next() continues from there. Valid
  /// until the next call. Throws InputError when there is no such frame.
  Frame at(std::uint32_t index);

  Frame rewind() final { return at(0); }
  std::optional<Frame> next() final;

  /// The name in messages: a recording's path, else the scene's name.
  [[nodiscard]] virtual const std::string& name() const { return scene().name; }

 protected:
  /// The boxes of frame `index`, which must exist. Valid until the next call.
  virtual std::span<const Aabb> readBoxes(std::uint32_t index) = 0;
  /// The changes of the last frame read, as Frame::changed.
  [[nodiscard]] virtual std::optional<std::span<const std::uint32_t>> changed() const { return {}; }
  /// The filter of the last frame read, as Frame::filter.
  [[nodiscard]] virtual const CollisionFilter* filter() const { return nullptr; }
  /// The changes of the filter in the last frame read, as Frame::filter_changed.
  [[nodiscard]] virtual std::span<const std::uint32_t> filterChanged() const { return {}; }

 private:
  std::uint32_t position_ = 0;
};

/// All frames of a source, held in memory: 32 · objects · (1 + frames) bytes, and each filter.
/// Frames have no lists of changes; their boxes are valid as long as the list.
class FrameList final : public IndexedFrames {
 public:
  /// Reads all frames, from rewind() on. Throws what the source throws, and std::bad_alloc.
  explicit FrameList(FrameSource& source);

  [[nodiscard]] const SceneInfo& scene() const override { return scene_; }

 private:
  std::span<const Aabb> readBoxes(std::uint32_t index) override;
  [[nodiscard]] const CollisionFilter* filter() const override {
    return filters_.empty() ? nullptr : &filters_[last_];
  }

  SceneInfo scene_;
  LargeVector<Aabb> boxes_;
  std::vector<CollisionFilter> filters_;  ///< by frame; empty unless filters change
  std::uint32_t last_ = 0;                ///< frame
};

}  // namespace broadmark
