// The cost model assumes that boxes are spread evenly over the trimmed range of the sample. Then
// the width of the columns and the sweep axis determine the number of entries and of tests. Uneven
// distributions are left to the traversal, which splits crowded columns.

#include "columns/layout.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sample.h"

namespace broadmark::columns {
namespace {

/// The mean box, relative to the ranges.
struct RelativeExtents {
  std::array<double, 3> edges{};           ///< by axis
  std::array<double, 3> cross_sections{};  ///< by axis: the product of the other two edges
};

RelativeExtents meanExtents(std::span<const Aabb> sample,
                            const std::array<TrimmedRange, 3>& ranges) {
  RelativeExtents mean;
  for (const Aabb& box : sample) {
    std::array<double, 3> edges;
    for (int axis = 0; axis < 3; ++axis) edges[axis] = ranges[axis].relativeExtent(box, axis);
    for (int axis = 0; axis < 3; ++axis) {
      mean.edges[axis] += edges[axis];
      mean.cross_sections[axis] += edges[(axis + 1) % 3] * edges[(axis + 2) % 3];
    }
  }
  for (int axis = 0; axis < 3; ++axis) {
    mean.edges[axis] /= static_cast<double>(sample.size());
    mean.cross_sections[axis] /= static_cast<double>(sample.size());
  }
  return mean;
}

/// Half the probability that two boxes overlap on an axis, since a window holds only the box that
/// begins later. Estimated from pairs of the sample: boxes need not be spread evenly.
double sampledOverlapFraction(std::span<const Aabb> sample, int axis) {
  constexpr std::size_t kRounds = 4;
  std::size_t overlaps = 0;
  for (std::size_t round = 1; round <= kRounds; ++round) {
    const std::size_t stride = sample.size() * round / (kRounds + 1) + 1;
    for (std::size_t i = 0; i + stride < sample.size(); ++i) {
      const Aabb& a = sample[i];
      const Aabb& b = sample[i + stride];
      overlaps += std::size_t{a.min[axis] <= b.max[axis]} & std::size_t{b.min[axis] <= a.max[axis]};
    }
  }
  const auto pairs = static_cast<double>(kRounds * sample.size()) / 2;
  return static_cast<double>(overlaps) / pairs / 2;
}

}  // namespace

Layout::Layout(std::span<const Aabb> sample, std::size_t count, double copy_cost) {
  sample = sample.first(std::min(sample.size(), kMaxSampleSize));
  if (sample.empty()) return;
  std::array<TrimmedRange, 3> ranges;
  for (int axis = 0; axis < 3; ++axis) ranges[axis] = trimmedRange(sample, axis);
  const RelativeExtents mean = meanExtents(sample, ranges);

  // Search every sweep axis and, for columns of square cross-section, every width.
  std::array<int, 3> axes = {0, 1, 2};
  cost_ = std::numeric_limits<double>::max();
  for (int sweep = 0; sweep < 3; ++sweep) {
    const int a = (sweep + 1) % 3;
    const int b = (sweep + 2) % 3;
    const double overlap_fraction =
        std::max(mean.edges[sweep], sampledOverlapFraction(sample, sweep));
    const double longer = std::max(ranges[a].extent(), ranges[b].extent());
    for (double width = longer;; width *= 0.85) {
      const auto count_on = [&](int axis) {
        const double columns = std::round(ranges[axis].extent() / width);
        return columns > 1 ? columns : 1;  // 1 also for 0/0, where the extent is 0
      };
      const double count_a = count_on(a);
      const double count_b = count_on(b);
      if (count_a * count_b > static_cast<double>(kMaxColumns)) break;
      // A box has one entry, and another one for each column boundary that it crosses.
      const double boundaries_a = count_a - 1;
      const double boundaries_b = count_b - 1;
      const double entries = 1 + boundaries_a * mean.edges[a] + boundaries_b * mean.edges[b] +
                             boundaries_a * boundaries_b * mean.cross_sections[sweep];
      const double in_column = static_cast<double>(count) * entries / (count_a * count_b);
      const double window = in_column * overlap_fraction;
      const double cost = entries * (copy_cost + window);
      if (cost < cost_) {
        cost_ = cost;
        overlap_fraction_ = overlap_fraction;
        axes = {sweep, a, b};
        counts_ = {static_cast<std::int32_t>(count_a), static_cast<std::int32_t>(count_b)};
      }
      if (!(width > 0)) break;
      // Narrower columns only add entries from here on.
      if (entries * copy_cost > cost_) break;
    }
  }

  const auto scale = [](double values, const TrimmedRange& range) {
    constexpr double kMax = std::numeric_limits<float>::max();
    return range.extent() > 0 ? static_cast<float>(std::min(values / range.extent(), kMax)) : 0;
  };
  const TrimmedRange& swept = ranges[axes[0]];
  // The last float below 2^kSweepBits.
  constexpr auto kMaxSweepCoord = static_cast<float>((1U << Layout::kSweepBits) - 128);
  quantizers_.sweep = {.axis = axes[0],
                       .origin = static_cast<float>(swept.low),
                       .scale = scale(kMaxSweepCoord, swept),
                       .max = kMaxSweepCoord};
  for (int i = 0; i < 2; ++i) {
    const TrimmedRange& range = ranges[axes[i + 1]];
    const int values = counts_[i] << kCoordBits;
    quantizers_.cut[i] = {.axis = axes[i + 1],
                          .origin = static_cast<float>(range.low),
                          .scale = scale(values, range),
                          .max = static_cast<float>(values - 1)};
  }
  quantizers_.columns_per_row = static_cast<std::uint32_t>(counts_[0]);
}

void Layout::coarsen() {
  for (int i = 0; i < 2; ++i) {
    Quantizer& quantizer = quantizers_.cut[i];
    const std::int32_t before = counts_[i];
    counts_[i] = (before + 1) / 2;
    quantizer.scale *= static_cast<float>(counts_[i]) / static_cast<float>(before);
    quantizer.max = static_cast<float>((counts_[i] << kCoordBits) - 1);
  }
  quantizers_.columns_per_row = static_cast<std::uint32_t>(counts_[0]);
}

Aabb Layout::columnBox(std::size_t index, const Aabb& bounds) const {
  Aabb box = bounds;
  for (int i = 0; i < 2; ++i) {
    const Quantizer& quantizer = quantizers_.cut[i];
    const int axis = quantizer.axis;
    const auto count = static_cast<std::size_t>(counts_[i]);
    const std::size_t position = index % count;
    index /= count;
    const auto boundary = [&](std::size_t k) {
      return static_cast<float>(quantizer.origin +
                                static_cast<double>(k << kCoordBits) / quantizer.scale);
    };
    if (position > 0) box.min[axis] = std::max(box.min[axis], boundary(position));
    if (position + 1 < count) box.max[axis] = std::min(box.max[axis], boundary(position + 1));
  }
  return box;
}

}  // namespace broadmark::columns
