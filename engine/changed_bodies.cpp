// Comparing boxes with those of the frame before.

#include "broadmark/changed_bodies.h"

#include <array>
#include <bit>

namespace broadmark {
namespace {

/// To the bit, so that what is recorded comes back as it was.
bool same(const Aabb& a, const Aabb& b) {
  using Bits = std::array<std::uint64_t, 4>;
  return std::bit_cast<Bits>(a) == std::bit_cast<Bits>(b);
}

}  // namespace

Frame ChangedBodies::complete(const Frame& frame) {
  if (frame.changed) return frame;
  changed_.clear();
  if (frame.index == 0) {
    before_.assign(frame.boxes.begin(), frame.boxes.end());
    changed_.reserve(before_.size());
  }
  for (std::uint32_t body = 0; body < before_.size(); ++body) {
    if (same(frame.boxes[body], before_[body])) continue;
    before_[body] = frame.boxes[body];
    changed_.push_back(body);
  }
  return {frame.index, frame.boxes, changed_};
}

}  // namespace broadmark
