// A sample of the boxes, and what it tells: by this, grids choose their cells.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "broadmark/aabb.h"
#include "prefetch.h"

namespace broadmark {

inline constexpr std::size_t kMostSampled = 2048;

/// Of how many boxes of `count` a sample is taken: at most kMostSampled.
constexpr std::size_t sampleSize(std::size_t count) {
  return std::min(count, std::clamp<std::size_t>(count / 32, 256, kMostSampled));
}

/// The k-th of a sample of `of` of `count`. Spread by the golden ratio and not by a stride, since
/// scenes give bodies their shapes by number, in turn.
constexpr std::size_t sampled(std::size_t k, std::size_t of, std::size_t count) {
  if (of == count) return k;
  return static_cast<std::uint32_t>(k * 0x9E3779B9U) * std::uint64_t{count} >> 32;
}

/// Takes a sample of `count` boxes, of which box_of(i) is the i-th, by reference.
template <class BoxOf>
void takeSample(std::size_t count, BoxOf box_of, std::vector<Aabb>& sample) {
  sample.resize(sampleSize(count));
  const auto sampled_box = [&](std::size_t k) -> const Aabb& {
    return box_of(sampled(k, sample.size(), count));
  };
  for (std::size_t k = 0; k < sample.size(); ++k) {
    if (k + kPrefetchAhead < sample.size()) prefetch(&sampled_box(k + kPrefetchAhead));
    sample[k] = sampled_box(k);
  }
}

/// Where the bulk of the boxes lies on one axis. In double: there no float overflows.
struct Bulk {
  double low = 0;
  double high = 0;
  [[nodiscard]] double extent() const { return high - low; }
  /// How much of the extent an edge takes up, at most all of it.
  [[nodiscard]] double part(const Aabb& box, int axis) const {
    const double edge = static_cast<double>(box.max[axis]) - static_cast<double>(box.min[axis]);
    return edge < extent() ? edge / extent() : 1;
  }
};

/// Where nine tenths of the boxes of a sample lie, and a quarter of that more on both sides: for
/// most distributions that holds nearly everything. A few boxes far off don't stretch it. The
/// sample has from one to kMostSampled boxes.
Bulk bulkOf(std::span<const Aabb> sample, int axis);

}  // namespace broadmark
