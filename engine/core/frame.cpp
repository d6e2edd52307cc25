// Frames by index.

#include "broadmark/frame.h"

#include <fmt/format.h>

#include "broadmark/error.h"

namespace broadmark {

std::vector<std::uint32_t> Frame::presentBodies() const {
  std::vector<std::uint32_t> present;
  for (std::uint32_t body = 0; body < boxes.size(); ++body) {
    if (!isEmpty(boxes[body])) present.push_back(body);
  }
  return present;
}

Frame IndexedFrames::at(std::uint32_t index) {
  if (index > scene().frames) {
    throw InputError(
        fmt::format("{}: no frame {}: the last one is {}", name(), index, scene().frames));
  }
  const std::span<const Aabb> boxes = readBoxes(index);
  position_ = index;
  return {index, boxes, changed(), filter(), filterChanged()};
}

std::optional<Frame> IndexedFrames::next() {
  if (position_ >= scene().frames) return std::nullopt;
  return at(position_ + 1);
}

FrameList::FrameList(FrameSource& source) : scene_(source.scene()) {
  boxes_.reserve(std::size_t{scene_.objects} * (std::size_t{scene_.frames} + 1));
  for (std::optional<Frame> frame = source.rewind(); frame; frame = source.next()) {
    boxes_.insert(boxes_.end(), frame->boxes.begin(), frame->boxes.end());
    if (scene_.filter_changes) filters_.push_back(frame->filterIn(scene_));
  }
}

std::span<const Aabb> FrameList::readBoxes(std::uint32_t index) {
  last_ = index;
  return std::span(boxes_).subspan(std::size_t{index} * scene_.objects, scene_.objects);
}

}  // namespace broadmark
