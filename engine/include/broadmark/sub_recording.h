// A part of a recording: some bodies, some frames.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "broadmark/frame.h"

namespace broadmark {

class Recording;

/// Any frame of any source, forwards or backwards: a recording goes there at once, any other source
/// steps, from the start if need be.
class FrameSeeker {
 public:
  /// `source` outlives this and is used by nobody else meanwhile.
  explicit FrameSeeker(FrameSource& source);

  [[nodiscard]] const SceneInfo& scene() const { return source_.scene(); }
  /// Frame `index`, valid until the next call. Throws InputError when there is none.
  Frame at(std::uint32_t index);

 private:
  FrameSource& source_;
  Recording* recording_;  ///< the same, when it is one
  Frame present_;
  bool started_ = false;
};

/// Which part. Bodies and frames keep their order and are numbered anew, from 0.
struct Selection {
  std::vector<std::uint32_t> bodies;  ///< ascending
  std::vector<std::uint32_t> frames;  ///< ascending; the first becomes the initial pose

  friend bool operator==(const Selection&, const Selection&) = default;
};

/// All bodies in frames 0…last.
Selection wholeSelection(const SceneInfo&, std::uint32_t last_frame);

/// The selected part as a source of its own: same world, the given name.
class SubRecording final : public FrameSource {
 public:
  /// `whole` outlives this; the selection's numbers exist in it.
  SubRecording(FrameSeeker& whole, Selection selection, std::string name);

  [[nodiscard]] const SceneInfo& scene() const override { return scene_; }
  Frame rewind() override { return at(0); }
  std::optional<Frame> next() override;

 private:
  Frame at(std::uint32_t index);

  FrameSeeker& whole_;
  Selection selection_;
  SceneInfo scene_;
  std::uint32_t index_ = 0;
  std::vector<Aabb> boxes_;
};

/// A source's frames, held in memory: scene().objects · (1 + scene().frames) · 32 bytes.
class FrameList final : public FrameSource {
 public:
  explicit FrameList(FrameSource& source);

  [[nodiscard]] const SceneInfo& scene() const override { return scene_; }
  Frame rewind() override { return at(0); }
  std::optional<Frame> next() override;

 private:
  Frame at(std::uint32_t index);

  SceneInfo scene_;
  std::uint32_t index_ = 0;
  std::vector<Aabb> boxes_;
};

}  // namespace broadmark
