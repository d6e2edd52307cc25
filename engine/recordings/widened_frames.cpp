// Widened boxes for arbitrary frames. If the changed bodies are known, the cost of a frame is
// theirs.

#include "broadmark/recordings/widened_frames.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "broadmark/exact_sum.h"
#include "recording_file.h"

namespace broadmark {
namespace {

constexpr float kLargestFloat = std::numeric_limits<float>::max();

}  // namespace

Aabb widenedBox(const Aabb& box, double distance) {
  if (isEmpty(box)) return kEmptyBox;
  // Half of the smallest number above zero would be zero.
  const double half =
      distance > 0 ? std::max(distance / 2, std::numeric_limits<double>::denorm_min()) : 0;
  Aabb widened;
  for (int axis = 0; axis < 3; ++axis) {
    const float min = std::max(floatBelow({box.min[axis], -half}), -kLargestFloat);
    widened.min[axis] = min + 0.0F;  // never -0
    widened.max[axis] = std::min(floatAbove({box.max[axis], half}), kLargestFloat);
  }
  return widened;
}

SceneInfo widenedScene(SceneInfo scene, double distance) {
  scene.name = suffixedName(scene, kWidenedSuffix);
  scene.world = widenedBox(scene.world, distance);
  return scene;
}

WidenedFrames::WidenedFrames(std::unique_ptr<IndexedFrames> frames, double distance)
    : AdaptedFrames(std::move(frames)), distance_(distance) {
  scene_ = widenedScene(std::move(scene_), distance);
  changed_.reserve(scene_.objects);
}

std::span<const Aabb> WidenedFrames::readBoxes(std::uint32_t index) {
  const std::optional<std::uint32_t> last = std::exchange(last_, {});  // in case reading fails
  // Change detection needs the widened boxes of the frame before.
  if (index > 0 && last != index - 1) widenAll(readSource(index - 1));
  const Frame frame = readSource(index);
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

void WidenedFrames::widenAll(const Frame& frame) {
  for (std::size_t body = 0; body < boxes_.size(); ++body) {
    boxes_[body] = widenedBox(frame.boxes[body], distance_);
  }
}

}  // namespace broadmark
