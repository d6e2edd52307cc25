// Finds the bodies with boxes or collision filters that differ from the frame before.
//
// Example:
//
//   const std::vector<Aabb> before = {{{0, 0, 0}, {1, 1, 1}}, {{4, 0, 0}, {5, 1, 1}}};
//   std::vector<Aabb> after = before;
//   after[1] = kEmptyBox;
//   ChangeDetector detector;
//   detector.complete({0, before});
//   const Frame frame = detector.complete({1, after});  // *frame.changed: 1
#pragma once

#include <cstdint>
#include <vector>

#include "broadmark/frame.h"

namespace broadmark {

/// Fills in Frame::changed and Frame::filter_changed for sources that do not provide them. Retains
/// a copy of the boxes, which it compares bitwise. A steady state allocates nothing.
///
/// Requires all frames of a run, in order, from frame 0 on, which begins a new run; their number of
/// bodies must be the same.
class ChangeDetector {
 public:
  /// Returns the frame with the bodies changed since the last call; none in frame 0. Lists that the
  /// frame has are kept, new ones are valid until the next call. O(n). Does not find the changes of
  /// a LiveFilter, which the copy retained here follows.
  Frame complete(Frame frame) {
    if (frame.filter != nullptr) completeFilter(frame);
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
    frame.changed = changed_;
    return frame;
  }

 private:
  void completeFilter(Frame& frame) {
    const bool compares = frame.index > 0 && frame.filter_changed.empty();
    if (compares && *frame.filter != filter_before_) {
      filter_changed_.clear();
      for (std::uint32_t body = 0; body < frame.boxes.size(); ++body) {
        if (frame.filter->groupsOf(body) == filter_before_.groupsOf(body)) continue;
        filter_changed_.push_back(body);
      }
      frame.filter_changed = filter_changed_;
    }
    filter_before_ = *frame.filter;
  }

  std::vector<Aabb> before_;
  std::vector<std::uint32_t> changed_;
  CollisionFilter filter_before_;
  std::vector<std::uint32_t> filter_changed_;
};

}  // namespace broadmark
