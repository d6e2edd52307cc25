#include "broadmark/recordings/mapped_frames.h"

#include <fmt/format.h>

#include <utility>

#include "broadmark/error.h"

namespace broadmark {

MappedFrames::MappedFrames(std::unique_ptr<IndexedFrames> frames, SceneInfo scene, Map map)
    : AdaptedFrames(std::move(frames)), map_(std::move(map)) {
  scene_ = std::move(scene);
  changed_.reserve(scene_.objects);
}

std::span<const Aabb> MappedFrames::readBoxes(std::uint32_t index) {
  const std::optional<std::uint32_t> last = std::exchange(last_, {});  // in case reading fails
  // Change detection needs the mapped boxes of the frame before.
  if (index > 0 && last != index - 1) mapAll(readSource(index - 1));
  const Frame frame = readSource(index);
  changed_.clear();
  if (index == 0 || !reports_changes_) {
    mapAll(frame);
  } else {
    for (const std::uint32_t body : *frame.changed) {
      const Aabb box = mapped(frame, body);
      if (sameBits(box, boxes_[body])) continue;  // two boxes may be mapped to the same one
      boxes_[body] = box;
      changed_.push_back(body);
    }
  }
  last_ = index;
  return boxes_;
}

void MappedFrames::mapAll(const Frame& frame) {
  for (std::size_t body = 0; body < boxes_.size(); ++body) boxes_[body] = mapped(frame, body);
}

Aabb MappedFrames::mapped(const Frame& frame, std::size_t body) const {
  try {
    return map_(frame.boxes[body]);
  } catch (const InputError& error) {
    throw InputError(
        fmt::format("{}: frame {}, body {}: {}", name(), frame.index, body, error.what()));
  }
}

}  // namespace broadmark
