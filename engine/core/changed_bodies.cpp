// Comparing boxes with those of the frame before.

#include "broadmark/changed_bodies.h"

namespace broadmark {

Frame ChangedBodies::complete(const Frame& frame) {
  if (frame.changed) return frame;
  changed_.clear();
  if (frame.index == 0) {
    before_.assign(frame.boxes.begin(), frame.boxes.end());
    changed_.reserve(before_.size());
  }
  for (std::uint32_t body = 0; body < before_.size(); ++body) {
    if (sameBits(frame.boxes[body], before_[body])) continue;
    before_[body] = frame.boxes[body];
    changed_.push_back(body);
  }
  return {frame.index, frame.boxes, changed_};
}

}  // namespace broadmark
