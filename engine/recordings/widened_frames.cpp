#include "broadmark/recordings/widened_frames.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "broadmark/exact_sum.h"
#include "broadmark/recordings/mapped_frames.h"
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

std::unique_ptr<IndexedFrames> widened(std::unique_ptr<IndexedFrames> frames, double distance) {
  SceneInfo scene = widenedScene(frames->scene(), distance);
  return std::make_unique<MappedFrames>(
      std::move(frames), std::move(scene),
      [distance](const Aabb& box) { return widenedBox(box, distance); });
}

}  // namespace broadmark
