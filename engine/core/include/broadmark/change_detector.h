// Finds the bodies with boxes that differ from the frame before.
#pragma once

#include <cstdint>
#include <vector>

#include "broadmark/frame.h"

namespace broadmark {

/// Fills in Frame::changed for sources that do not provide it. Retains a copy of the boxes. A
/// steady state allocates nothing.
class ChangeDetector {
 public:
  /// Returns the frame with the bodies changed since the last call; none in frame
  /// 0. Valid until the next call.
  Frame complete(const Frame& frame) {
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

 private:
  std::vector<Aabb> before_;
  std::vector<std::uint32_t> changed_;
};

}  // namespace broadmark
