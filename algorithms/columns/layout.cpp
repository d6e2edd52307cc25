// Choosing columns. From the sample come, for each axis, where the bulk of the boxes lies and how
// long they are. If boxes were spread evenly there, the number of copies and of tests would follow
// from the width of the columns and the axis of the sweep; the cheapest of all choices is taken.
// What is not spread evenly is for the columns themselves to find out: crowded ones are split.

#include "columns/layout.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sample.h"

namespace broadmark::columns {
namespace {

/// Mean parts of the extents that boxes take up.
struct Parts {
  std::array<double, 3> of{};       ///< by axis
  std::array<double, 3> without{};  ///< by axis: the product of the two others
};

Parts meanParts(std::span<const Aabb> sample, const std::array<Bulk, 3>& axes) {
  Parts mean;
  for (const Aabb& box : sample) {
    std::array<double, 3> part;
    for (int axis = 0; axis < 3; ++axis) part[axis] = axes[axis].part(box, axis);
    for (int axis = 0; axis < 3; ++axis) {
      mean.of[axis] += part[axis];
      mean.without[axis] += part[(axis + 1) % 3] * part[(axis + 2) % 3];
    }
  }
  for (int axis = 0; axis < 3; ++axis) {
    mean.of[axis] /= static_cast<double>(sample.size());
    mean.without[axis] /= static_cast<double>(sample.size());
  }
  return mean;
}

/// How much of the others a box meets on an axis behind its lower bound, by pairs of the sample.
/// The mean part of the extent would do, were boxes spread evenly.
double meetingPart(std::span<const Aabb> sample, int axis) {
  constexpr std::size_t kRounds = 4;
  std::size_t meetings = 0;
  for (std::size_t round = 1; round <= kRounds; ++round) {
    const std::size_t away = sample.size() * round / (kRounds + 1) + 1;
    for (std::size_t i = 0; i + away < sample.size(); ++i) {
      const Aabb& a = sample[i];
      const Aabb& b = sample[i + away];
      meetings += std::size_t{a.min[axis] <= b.max[axis]} & std::size_t{b.min[axis] <= a.max[axis]};
    }
  }
  const auto pairs = static_cast<double>(kRounds * sample.size()) / 2;
  return static_cast<double>(meetings) / pairs / 2;
}

}  // namespace

Layout::Layout(std::span<const Aabb> sample, std::size_t count, double copy_cost) {
  sample = sample.first(std::min(sample.size(), kMostSampled));
  if (sample.empty()) return;
  std::array<Bulk, 3> measured;
  for (int axis = 0; axis < 3; ++axis) measured[axis] = bulkOf(sample, axis);
  const Parts parts = meanParts(sample, measured);

  std::array<int, 3> axes = {0, 1, 2};
  cost_ = std::numeric_limits<double>::max();
  for (int sweep = 0; sweep < 3; ++sweep) {
    const int first = (sweep + 1) % 3;
    const int second = (sweep + 2) % 3;
    const double met = std::max(parts.of[sweep], meetingPart(sample, sweep));
    // Columns of square cross-section: their side is what is tried out.
    const double longer = std::max(measured[first].extent(), measured[second].extent());
    for (double side = longer;; side *= 0.85) {
      const auto cuts = [&](int axis) {
        const double columns = std::round(measured[axis].extent() / side);
        return columns > 1 ? columns : 1;  // also when there is no extent: 0/0
      };
      const double firsts = cuts(first);
      const double seconds = cuts(second);
      if (firsts * seconds > static_cast<double>(kMostColumns)) break;
      // A box lies in one column, and in another one for each side that it crosses.
      const double crossed_first = firsts - 1;
      const double crossed_second = seconds - 1;
      const double copies = 1 + crossed_first * parts.of[first] +
                            crossed_second * parts.of[second] +
                            crossed_first * crossed_second * parts.without[sweep];
      const double in_column = static_cast<double>(count) * copies / (firsts * seconds);
      const double window = in_column * met;
      const double cost = copies * (copy_cost + window);
      if (cost < cost_) {
        cost_ = cost;
        met_ = met;
        axes = {sweep, first, second};
        counts_ = {static_cast<std::int32_t>(firsts), static_cast<std::int32_t>(seconds)};
      }
      if (!(side > 0)) break;
      // Narrower columns only cost more copies from here on.
      if (copies * copy_cost > cost_) break;
    }
  }
  const auto factor = [](double steps, const Bulk& axis) {
    constexpr double kMost = std::numeric_limits<float>::max();
    return axis.extent() > 0 ? static_cast<float>(std::min(steps / axis.extent(), kMost)) : 0;
  };
  const Bulk& swept = measured[axes[0]];
  // The last float below 2^kSweepBits.
  constexpr auto kLastSweepStep = static_cast<float>((1U << Layout::kSweepBits) - 128);
  scales_.sweep = {.axis = axes[0],
                   .low = static_cast<float>(swept.low),
                   .factor = factor(kLastSweepStep, swept),
                   .last = kLastSweepStep};
  for (int which = 0; which < 2; ++which) {
    const Bulk& cut = measured[axes[which + 1]];
    const int steps = counts_[which] << kStepBits;
    scales_.of[which] = {.axis = axes[which + 1],
                         .low = static_cast<float>(cut.low),
                         .factor = factor(steps, cut),
                         .last = static_cast<float>(steps - 1)};
  }
  scales_.columns_in_row = static_cast<std::uint32_t>(counts_[0]);
}

void Layout::widen() {
  for (int which = 0; which < 2; ++which) {
    StepScale& scale = scales_.of[which];
    const std::int32_t before = counts_[which];
    counts_[which] = (before + 1) / 2;
    scale.factor *= static_cast<float>(counts_[which]) / static_cast<float>(before);
    scale.last = static_cast<float>((counts_[which] << kStepBits) - 1);
  }
  scales_.columns_in_row = static_cast<std::uint32_t>(counts_[0]);
}

Aabb Layout::column(std::size_t index, const Aabb& bounds) const {
  Aabb box = bounds;
  for (int which = 0; which < 2; ++which) {
    const StepScale& scale = scales_.of[which];
    const int axis = scale.axis;
    const auto count = static_cast<std::size_t>(counts_[which]);
    const std::size_t at = index % count;
    index /= count;
    const auto side = [&](std::size_t k) {
      return static_cast<float>(scale.low + static_cast<double>(k << kStepBits) / scale.factor);
    };
    if (at > 0) box.min[axis] = std::max(box.min[axis], side(at));
    if (at + 1 < count) box.max[axis] = std::min(box.max[axis], side(at + 1));
  }
  return box;
}

}  // namespace broadmark::columns
