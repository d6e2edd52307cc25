#include "sample.h"

#include <array>

namespace broadmark {
namespace {

/// Of some numbers, the lowest and where a twentieth of them ends.
struct LowEnd {
  float least;
  float twentieth;
};

/// Selects among those that are not above a pivot, which comes from every 16th number. That is most
/// of the work, and has no branch that could be predicted wrong. After: R. Floyd, R. Rivest,
/// "Expected time bounds for selection", Communications of the ACM 18 (1975).
LowEnd lowEndOf(std::span<const float> numbers) {
  constexpr std::size_t kStride = 16;
  constexpr double kPart = 0.05;
  constexpr double kPivotPart = 0.15;
  const auto place_of = [](double part, std::size_t count) {
    return static_cast<std::ptrdiff_t>(part * static_cast<double>(count - 1));
  };
  std::array<float, kMostSampled / kStride + 1> few;
  std::size_t few_count = 0;
  for (std::size_t i = 0; i < numbers.size(); i += kStride) few[few_count++] = numbers[i];
  const auto pivot = few.begin() + place_of(kPivotPart, few_count);
  std::nth_element(few.begin(), pivot, few.begin() + few_count);

  std::array<float, kMostSampled> low;
  const std::ptrdiff_t wanted = place_of(kPart, numbers.size());
  auto end = low.begin();
  for (const float number : numbers) {
    *end = number;
    end += number <= *pivot ? 1 : 0;
  }
  if (end - low.begin() <= wanted) end = std::ranges::copy(numbers, low.begin()).out;
  std::nth_element(low.begin(), low.begin() + wanted, end);
  return {*std::min_element(low.begin(), low.begin() + wanted + 1), low[wanted]};
}

}  // namespace

Bulk bulkOf(std::span<const Aabb> sample, int axis) {
  std::array<float, kMostSampled> numbers;
  const auto low_end = [&](auto number_of) {
    std::ranges::transform(sample, numbers.begin(), number_of);
    return lowEndOf(std::span(numbers).first(sample.size()));
  };
  const LowEnd lows = low_end([=](const Aabb& box) { return box.min[axis]; });
  const LowEnd highs = low_end([=](const Aabb& box) { return -box.max[axis]; });
  const double low = lows.twentieth;
  const double high = -highs.twentieth;
  const double more = (high - low) / 4;
  return {std::max<double>(lows.least, low - more), std::min<double>(-highs.least, high + more)};
}

}  // namespace broadmark
