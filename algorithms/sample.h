// A sample of the boxes, and their trimmed range on an axis: grids choose their cells by these.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "broadmark/aabb.h"
#include "prefetch.h"

namespace broadmark {

inline constexpr std::size_t kMaxSampleSize = 2048;

/// The size of the sample of `count` boxes.
constexpr std::size_t sampleSize(std::size_t count) {
  return std::min(count, std::clamp<std::size_t>(count / 32, 64, kMaxSampleSize));
}

/// The index of the k-th box in a sample of `size` out of `count`. A golden-ratio sequence, as a
/// stride could fall in step with scenes that cycle through body shapes.
constexpr std::size_t sampleIndex(std::size_t k, std::size_t size, std::size_t count) {
  if (size == count) return k;
  return static_cast<std::uint32_t>(k * 0x9E3779B9U) * std::uint64_t{count} >> 32;
}

/// Samples `count` boxes; box_at(i) returns a reference to box i.
template <class BoxAt>
void takeSample(std::size_t count, BoxAt box_at, std::vector<Aabb>& sample) {
  sample.resize(sampleSize(count));
  const auto sampled_box = [&](std::size_t k) -> const Aabb& {
    return box_at(sampleIndex(k, sample.size(), count));
  };
  for (std::size_t k = 0; k < sample.size(); ++k) {
    if (k + kPrefetchDistance < sample.size()) prefetch(&sampled_box(k + kPrefetchDistance));
    sample[k] = sampled_box(k);
  }
}

/// The range of most boxes on one axis. In double, where differences of floats cannot overflow.
struct TrimmedRange {
  double low = 0;
  double high = 0;
  [[nodiscard]] double extent() const { return high - low; }
  /// The edge of a box as a fraction of the extent, at most 1.
  [[nodiscard]] double relativeExtent(const Aabb& box, int axis) const {
    const double edge = static_cast<double>(box.max[axis]) - static_cast<double>(box.min[axis]);
    return edge < extent() ? edge / extent() : 1;
  }
};

/// The range from the 5 % quantile of the lower bounds to the 95 % quantile of the upper ones, plus
/// a margin of a quarter on both sides, within the sample's bounds. It holds nearly all boxes of
/// most distributions, and a few outliers do not stretch it. The sample has 1 to kMaxSampleSize
/// boxes.
TrimmedRange trimmedRange(std::span<const Aabb> sample, int axis);

}  // namespace broadmark
