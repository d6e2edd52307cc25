// Choosing cells, and what is far off from them.

#include "tide/cells.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <vector>

namespace broadmark::tide {
namespace {

/// What it costs to look into a cell, in tests of a box.
constexpr double kCellCost = 2;
/// From one size of cells that is tried out to the next.
constexpr double kShorter = 0.7;

/// Mean and nearly largest edge of the boxes on an axis.
struct Edges {
  double mean = 0;
  double most = 0;
};

Edges edgesOf(std::span<const Aabb> sample, int axis) {
  std::vector<double> edges;
  double sum = 0;
  for (const Aabb& box : sample) {
    edges.push_back(static_cast<double>(box.max[axis]) - static_cast<double>(box.min[axis]));
    sum += edges.back();
  }
  const auto most = edges.begin() + static_cast<std::ptrdiff_t>(edges.size() * 9 / 10);
  std::ranges::nth_element(edges, most);
  return {sum / static_cast<double>(edges.size()), *most};
}

std::vector<Aabb> sampleOf(std::span<const Aabb> boxes) {
  std::vector<Aabb> sample;
  takeSample(
      boxes.size(), [&](std::size_t i) -> const Aabb& { return boxes[i]; }, sample);
  std::erase_if(sample, isEmpty);
  return sample;
}

/// How many others a box shares its cell with, on average. Cells far apart may count as one.
double crowding(std::span<const Aabb> boxes, double edge) {
  const std::size_t size = std::bit_ceil(2 * boxes.size());
  std::vector<std::uint32_t> counts(size, 0);
  const double scale = 1 / edge;
  double others = 0;
  for (const Aabb& box : boxes) {
    if (isEmpty(box)) continue;
    std::uint64_t mixed = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double cell = std::clamp(std::floor(box.min[axis] * scale), -1e15, 1e15);
      mixed = (mixed + static_cast<std::uint64_t>(static_cast<std::int64_t>(cell))) *
              0x9E37'79B9'7F4A'7C15;
      mixed ^= mixed >> 32;
    }
    others += 2 * counts[mixed & (size - 1)]++;
  }
  return others / static_cast<double>(boxes.size());
}

}  // namespace

void Cells::choose(std::span<const Aabb> boxes) {
  const std::vector<Aabb> sample = sampleOf(boxes);
  std::array<TrimmedRange, 3> bulk;
  for (int axis = 0; axis < 3 && !sample.empty(); ++axis) bulk[axis] = trimmedRange(sample, axis);
  chooseSteps(boxes, sample, bulk);
  chooseLevels(boxes, bulk);
}

/// The size of the cells that promises to cost least. It begins with large ones, a few bodies in
/// each were they spread evenly: where they are not, smaller ones are better.
void Cells::chooseSteps(std::span<const Aabb> boxes, std::span<const Aabb> sample,
                        const std::array<TrimmedRange, 3>& bulk) {
  constexpr double kBodiesInLargest = 4;
  constexpr double kShortest = 1e-30;
  constexpr double kLongest = 1e30;
  double edge = 1;
  low_ = {};
  if (!sample.empty()) {
    std::array<Edges, 3> edges;
    double longest = 0;
    for (int axis = 0; axis < 3; ++axis) {
      low_[axis] = static_cast<float>(bulk[axis].low);
      longest = std::max(longest, bulk[axis].extent());
      edges[axis] = edgesOf(sample, axis);
    }
    const auto cells = [&](double of_edge) {
      double product = 1;
      for (const TrimmedRange& on_axis : bulk) product *= std::max(1.0, on_axis.extent() / of_edge);
      return product;
    };
    const double wanted = static_cast<double>(boxes.size()) / kBodiesInLargest;
    edge = std::clamp(longest, kShortest, kLongest);
    while (cells(edge) < wanted && edge > kShortest) edge *= kShorter;

    const auto cost = [&](double of_edge) {
      double looked_into = 1;
      for (const Edges& on_axis : edges) {
        looked_into *= 1 + (on_axis.mean + std::min(on_axis.most, of_edge)) / of_edge;
      }
      return looked_into * (kCellCost + crowding(boxes, of_edge));
    };
    double least = cost(edge);
    const auto is_better = [&](double other) {
      if (other < kShortest) return false;
      const double of_other = cost(other);
      if (of_other >= least) return false;
      least = of_other;
      edge = other;
      return true;
    };
    while (is_better(edge * kShorter)) {
    }
    if (!is_better(edge * std::sqrt(kShorter))) is_better(edge / std::sqrt(kShorter));
  }
  factor_ = static_cast<float>((1 << kCellBits) / edge);
}

/// As many as it takes to cover the bulk, but not many more than bodies.
void Cells::chooseLevels(std::span<const Aabb> boxes, const std::array<TrimmedRange, 3>& bulk) {
  levels_ = {};
  used_levels_ = 0;
  std::array<std::uint32_t, kLevels> bodies{};
  for (const Aabb& box : boxes) {
    if (isEmpty(box)) continue;
    const Extent extent = extentOf(box);
    const std::uint32_t level = levelOf(extent);
    ++bodies[level];
    reach(extent, level);
  }
  Steps low{};
  Steps high{};
  for (int axis = 0; axis < 3; ++axis) {
    std::array<float, 4> corner = low_;
    low[axis] = stepsOf(corner)[axis];
    corner[axis] = static_cast<float>(bulk[axis].high);
    high[axis] = stepsOf(corner)[axis];
  }
  count_ = 0;
  for (std::uint32_t level = 0; level < kLevels; ++level) {
    Level& at = levels_[level];
    for (int axis = 0; axis < 3; ++axis) {
      at.first[axis] = low[axis] >> shiftOf(level);
      at.counts[axis] = (high[axis] >> shiftOf(level)) - at.first[axis] + 1;
    }
    const auto size = [&] { return 1.0 * at.counts[0] * at.counts[1] * at.counts[2]; };
    while (size() > 2.0 * bodies[level] + 1) {
      int most = 0;
      for (const int axis : {1, 2}) {
        if (at.counts[axis] > at.counts[most]) most = axis;
      }
      at.counts[most] = (at.counts[most] + 1) / 2;
    }
    at.strides[0] = 1;
    for (const int axis : {1, 2}) {
      at.strides[axis] = at.strides[axis - 1] * at.counts[axis - 1];
    }
    at.first_cell = count_;
    count_ += static_cast<std::uint32_t>(size());
  }
}

Steps Cells::wrappedFarOff(Steps from_first, const Level& at) {
  for (int axis = 0; axis < 3; ++axis) {
    from_first[axis] %= at.counts[axis];
    if (from_first[axis] < 0) from_first[axis] += at.counts[axis];
  }
  return from_first;
}

Cells::Surroundings Cells::surroundings(const Extent& extent, std::uint32_t level) const {
  constexpr std::int32_t kFarOff = std::numeric_limits<std::int32_t>::max();
  const Level& at = levels_[level];
  const auto [first, last] = rangeAround(extent, level);
  const Extent in_first = countedFrom(first, extent, level);
  // Beyond the bulk bounds tell nothing.
  const Steps in_bulk = (first >= at.first) & (last - at.first < at.counts);
  return {.first = wrapped(first, at),
          .counts = smaller(last - first + 1, at.counts),  // all there are, once each
          .extent = {in_bulk & in_first.min, in_bulk ? in_first.max : Steps{} + kFarOff}};
}

Aabb Cells::boxOf(Steps cell, std::uint32_t level) const {
  const double edge = std::ldexp(1.0, shiftOf(level)) / factor_;
  Aabb box;
  for (int axis = 0; axis < 3; ++axis) {
    box.min[axis] = static_cast<float>(low_[axis] + edge * cell[axis]);
    box.max[axis] = static_cast<float>(low_[axis] + edge * (cell[axis] + 1));
  }
  return box;
}

}  // namespace broadmark::tide
