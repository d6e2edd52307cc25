// Boxes as structure of arrays.

#include "broadmark/box_arrays.h"

#include <algorithm>
#include <limits>

namespace broadmark {
namespace {

constexpr std::size_t kArrays = 6;

}  // namespace

Aabb BoxArrays::box(std::size_t i) const {
  return {{min(0)[i], min(1)[i], min(2)[i], 0}, {max(0)[i], max(1)[i], max(2)[i], 0}};
}

void BoxArrays::resize(std::size_t size) {
  const auto padded = [](std::size_t boxes) {
    return (boxes + 2 * kPadding - 1) / kPadding * kPadding;
  };
  if (padded(size) > stride_) {
    // Grow geometrically, so that repeated small growth rarely reallocates.
    const std::size_t stride = std::max(padded(size), padded(stride_ + stride_ / 2));
    memory_.reset(static_cast<float*>(allocateLarge(kArrays * stride * sizeof(float))));
    stride_ = stride;
  }
  size_ = size;
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    std::fill_n(min(axis) + size, kPadding, kInfinity);
    std::fill_n(max(axis) + size, kPadding, -kInfinity);
  }
}

void BoxArrays::assign(std::span<const Aabb> boxes) {
  resize(boxes.size());
  for (int axis = 0; axis < 3; ++axis) {
    float* const low = min(axis);
    float* const high = max(axis);
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      low[i] = boxes[i].min[axis];
      high[i] = boxes[i].max[axis];
    }
  }
}

}  // namespace broadmark
