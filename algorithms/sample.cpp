#include "sample.h"

#include <array>

namespace broadmark {
namespace {

/// The minimum and the 5 % quantile of some values.
struct LowTail {
  float min;
  float quantile;
};

/// Quickselect among the values up to a pivot, which is chosen from every 16th value. Filtering by
/// the pivot is most of the work, and branchless. After: R. Floyd, R. Rivest, "Expected time bounds
/// for selection", Communications of the ACM 18 (1975).
LowTail lowTail(std::span<const float> values) {
  constexpr std::size_t kStride = 16;
  constexpr double kQuantile = 0.05;
  constexpr double kPivotQuantile = 0.15;
  const auto rank_of = [](double quantile, std::size_t count) {
    return static_cast<std::ptrdiff_t>(quantile * static_cast<double>(count - 1));
  };
  std::array<float, kMaxSampleSize / kStride + 1> strided;
  std::size_t strided_count = 0;
  for (std::size_t i = 0; i < values.size(); i += kStride) strided[strided_count++] = values[i];
  const auto pivot = strided.begin() + rank_of(kPivotQuantile, strided_count);
  std::nth_element(strided.begin(), pivot, strided.begin() + strided_count);

  std::array<float, kMaxSampleSize> low;
  const std::ptrdiff_t rank = rank_of(kQuantile, values.size());
  auto end = low.begin();
  for (const float value : values) {
    *end = value;
    end += value <= *pivot ? 1 : 0;
  }
  // The pivot was too low: select among all.
  if (end - low.begin() <= rank) end = std::ranges::copy(values, low.begin()).out;
  std::nth_element(low.begin(), low.begin() + rank, end);
  return {*std::min_element(low.begin(), low.begin() + rank + 1), low[rank]};
}

}  // namespace

TrimmedRange trimmedRange(std::span<const Aabb> sample, int axis) {
  std::array<float, kMaxSampleSize> values;
  const auto low_tail = [&](auto value_of) {
    std::ranges::transform(sample, values.begin(), value_of);
    return lowTail(std::span(values).first(sample.size()));
  };
  const LowTail mins = low_tail([=](const Aabb& box) { return box.min[axis]; });
  const LowTail negated_maxs = low_tail([=](const Aabb& box) { return -box.max[axis]; });
  const double low = mins.quantile;
  const double high = -negated_maxs.quantile;
  const double margin = (high - low) / 4;
  return {std::max<double>(mins.min, low - margin),
          std::min<double>(-negated_maxs.min, high + margin)};
}

}  // namespace broadmark
