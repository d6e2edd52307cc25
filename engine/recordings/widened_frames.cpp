// Widened boxes for arbitrary frames. If the changed bodies are known, the cost of a frame is
// theirs.

#include "broadmark/recordings/widened_frames.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "recording_file.h"

namespace broadmark {
namespace {

constexpr float kLargestFloat = std::numeric_limits<float>::max();

/// The smallest float that is at least a + b; the largest float beyond its range.
float sumRoundedUp(double a, double b) {
  const double sum = a + b;
  if (sum > kLargestFloat) return kLargestFloat;
  // What is missing from the sum, exactly (Knuth's two-sum).
  const double b_part = sum - a;
  const double error = (a - (sum - b_part)) + (b - b_part);
  const auto nearest = static_cast<float>(sum);
  if (nearest > sum || (nearest == sum && error <= 0)) return nearest;
  return std::nextafter(nearest, kLargestFloat);
}

}  // namespace

Aabb widenedBox(const Aabb& box, double distance) {
  if (isEmpty(box)) return kEmptyBox;
  // Half of the smallest number above zero would be zero.
  const double half =
      distance > 0 ? std::max(distance / 2, std::numeric_limits<double>::denorm_min()) : 0;
  Aabb widened;
  for (int axis = 0; axis < 3; ++axis) {
    widened.min[axis] = 0 - sumRoundedUp(-double{box.min[axis]}, half);  // never -0
    widened.max[axis] = sumRoundedUp(box.max[axis], half);
  }
  return widened;
}

SceneInfo widenedScene(SceneInfo scene, double distance) {
  scene.name = suffixedName(scene, kWidenedSuffix);
  scene.world = widenedBox(scene.world, distance);
  return scene;
}

WidenedFrames::WidenedFrames(std::unique_ptr<IndexedFrames> frames, double distance)
    : frames_(std::move(frames)),
      distance_(distance),
      scene_(widenedScene(frames_->scene(), distance)),
      boxes_(scene_.objects) {
  changed_.reserve(scene_.objects);
}

std::span<const Aabb> WidenedFrames::readBoxes(std::uint32_t index) {
  const std::optional<std::uint32_t> last = std::exchange(last_, {});  // in case reading fails
  // Change detection needs the widened boxes of the frame before.
  if (index > 0 && last != index - 1) widenAll(frames_->at(index - 1));
  const Frame frame = frames_->at(index);
  filter_ = frame.filter;
  filter_changed_ = frame.filter_changed;
  reports_changes_ = frame.changed.has_value();
  changed_.clear();
  if (index == 0 || !reports_changes_) {
    widenAll(frame);
  } else {
    for (const std::uint32_t body : *frame.changed) {
      const Aabb box = widenedBox(frame.boxes[body], distance_);
      if (sameBits(box, boxes_[body])) continue;  // a small step may be lost in rounding
      boxes_[body] = box;
      changed_.push_back(body);
    }
  }
  last_ = index;
  return boxes_;
}

std::optional<std::span<const std::uint32_t>> WidenedFrames::changed() const {
  if (!reports_changes_) return {};
  return changed_;
}

void WidenedFrames::widenAll(const Frame& frame) {
  for (std::size_t body = 0; body < boxes_.size(); ++body) {
    boxes_[body] = widenedBox(frame.boxes[body], distance_);
  }
}

}  // namespace broadmark
