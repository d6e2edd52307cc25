#include "sample.h"

#include <array>
#include <utility>

namespace broadmark {

Bulk bulkOf(std::span<const Aabb> sample, int axis) {
  std::array<double, kMostSampled> memory;
  const std::span bounds(memory.data(), sample.size());
  const auto quantile = [&](double part, auto bound) {
    std::ranges::transform(sample, bounds.begin(), bound);
    const double last = static_cast<double>(bounds.size() - 1);
    const auto at = bounds.begin() + static_cast<std::ptrdiff_t>(part * last);
    std::nth_element(bounds.begin(), at, bounds.end());
    return std::pair(*at, part < 0.5 ? *std::min_element(bounds.begin(), at + 1)
                                     : *std::max_element(at, bounds.end()));
  };
  const auto [low, least] = quantile(0.05, [=](const Aabb& box) { return box.min[axis]; });
  const auto [high, most] = quantile(0.95, [=](const Aabb& box) { return box.max[axis]; });
  const double more = (high - low) / 4;
  return {std::max(least, low - more), std::min(most, high + more)};
}

}  // namespace broadmark
