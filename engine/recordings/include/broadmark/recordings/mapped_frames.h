// Frames with each box replaced by a function of it.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>

#include "broadmark/frame.h"
#include "broadmark/recordings/adapted_frames.h"

namespace broadmark {

/// A source with mapped boxes. If the changed bodies are known, the cost of a frame is theirs.
class MappedFrames final : public AdaptedFrames {
 public:
  /// The new box of a body; kEmptyBox only for absent ones. May throw InputError with the fault of
  /// the box.
  using Map = std::function<Aabb(const Aabb&)>;

  /// `scene`: with the mapped boxes.
  MappedFrames(std::unique_ptr<IndexedFrames> frames, SceneInfo scene, Map map);

 private:
  std::span<const Aabb> readBoxes(std::uint32_t index) override;
  void mapAll(const Frame& frame);
  [[nodiscard]] Aabb mapped(const Frame& frame, std::size_t body) const;

  Map map_;
};

}  // namespace broadmark
