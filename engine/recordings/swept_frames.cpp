// Swept boxes for arbitrary frames. If the changed bodies are known, the cost of a frame is
// that of the bodies that changed in it and in the frame before: after a body stops, its swept box
// shrinks once more.

#include "broadmark/recordings/swept_frames.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "recording_file.h"

namespace broadmark {
namespace {

constexpr float kMaxFloat = std::numeric_limits<float>::max();

// The next lower float, limited to finite values.
float below(float value) { return std::nextafter(value, -kMaxFloat); }
float above(float value) { return std::nextafter(value, kMaxFloat); }

}  // namespace

Aabb sweptBox(const Aabb& before, const Aabb& now) {
  if (isEmpty(now)) return kEmptyBox;
  Aabb box = merged(before, now);  // the empty box adds nothing
  for (int axis = 0; axis < 3; ++axis) {
    box.min[axis] = below(box.min[axis]);
    box.max[axis] = above(box.max[axis]);
  }
  return box;
}

SceneInfo sweptScene(SceneInfo scene) {
  scene.name = suffixedName(scene, kSweptSuffix);
  return scene;
}

SweptFrames::SweptFrames(std::unique_ptr<IndexedFrames> frames) : AdaptedFrames(std::move(frames)) {
  scene_ = sweptScene(std::move(scene_));
}

std::span<const Aabb> SweptFrames::readBoxes(std::uint32_t index) {
  if (index == 0 || last_ != index - 1) {
    // Change detection needs the swept boxes of the frame before.
    std::uint32_t first = index - std::min(index, 2U);
    last_.reset();  // in case reading fails
    begin(first);
    while (first < index) advance(++first);
  } else {
    last_.reset();
    advance(index);
  }
  last_ = index;
  return boxes_;
}

void SweptFrames::begin(std::uint32_t index) {
  const Frame frame = readSource(index);
  before_.assign(frame.boxes.begin(), frame.boxes.end());
  for (std::size_t body = 0; body < boxes_.size(); ++body) {
    boxes_[body] = sweptBox(before_[body], before_[body]);
  }
  changed_.clear();
  // Any box may differ in the next frame, except after the initial pose.
  moved_.resize(index == 0 ? 0 : boxes_.size());
  std::iota(moved_.begin(), moved_.end(), 0U);
}

void SweptFrames::advance(std::uint32_t index) {
  const Frame frame = readSource(index);
  if (!frame.changed) {
    for (std::size_t body = 0; body < boxes_.size(); ++body) {
      boxes_[body] = sweptBox(before_[body], frame.boxes[body]);
    }
    std::ranges::copy(frame.boxes, before_.begin());
    return;
  }
  changed_.clear();
  for (const std::uint32_t body : candidates(*frame.changed)) {
    const Aabb box = sweptBox(before_[body], frame.boxes[body]);
    if (box == boxes_[body]) continue;
    boxes_[body] = box;
    changed_.push_back(body);
  }
  for (const std::uint32_t body : *frame.changed) before_[body] = frame.boxes[body];
  moved_.assign(frame.changed->begin(), frame.changed->end());
}

std::span<const std::uint32_t> SweptFrames::candidates(std::span<const std::uint32_t> changed) {
  candidates_.resize(moved_.size() + changed.size());
  const auto end = std::ranges::set_union(moved_, changed, candidates_.begin()).out;
  return std::span(candidates_.begin(), end);
}

}  // namespace broadmark
