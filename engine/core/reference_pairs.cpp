// The sweep: bodies are binned into strips along the second-longest axis (a body into every strip
// it touches); within a strip they are sorted along the longest axis and swept. A pair that shares
// several strips is reported only in the strip with the larger of its two lower bounds, so without
// duplicates or omissions: overlapping bodies share that strip. Each world is swept separately. O(n
// log n) plus the candidates of the sweeps.

#include "broadmark/reference_pairs.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <numeric>
#include <utility>

#include "broadmark/error.h"

namespace broadmark {
namespace {

/// A bijective mixer (splitmix64's finaliser): sums of mixed pairs hardly ever collide.
std::uint64_t mixed(Pair pair) {
  std::uint64_t x = (std::uint64_t{pair.a} << 32 | pair.b) + 0x9e3779b97f4a7c15U;
  x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9U;
  x = (x ^ x >> 27) * 0x94d049bb133111ebU;
  return x ^ x >> 31;
}

/// Equal-width strips over [low, high] of one axis. Monotone, so overlapping intervals share the
/// strips of their ends; ends are clamped, never dropped.
class Strips {
 public:
  /// Requires a box that is not empty; ignores empty boxes.
  Strips(std::span<const Aabb> boxes, int axis) : axis_(axis) {
    double edges = 0;
    std::size_t count = 0;
    double high = -std::numeric_limits<double>::infinity();
    low_ = -high;
    for (const Aabb& box : boxes) {
      if (isEmpty(box)) continue;
      ++count;
      low_ = std::min<double>(low_, box.min[axis]);
      high = std::max<double>(high, box.max[axis]);
      edges += static_cast<double>(box.max[axis]) - box.min[axis];
    }
    // Wide enough that a typical body touches little more than one strip.
    const double mean_edge = edges / static_cast<double>(count);
    const double desired =
        std::min((high - low_) / std::max(4 * mean_edge, 1e-300), static_cast<double>(count) / 32);
    count_ = static_cast<std::uint32_t>(std::clamp(desired, 1.0, 65536.0));
    scale_ = high > low_ ? count_ / (high - low_) : 0;
  }

  [[nodiscard]] std::uint32_t count() const { return count_; }
  [[nodiscard]] std::uint32_t of(float coordinate) const {
    const double strip = (coordinate - low_) * scale_;
    return static_cast<std::uint32_t>(std::clamp(strip, 0.0, count_ - 1.0));
  }
  [[nodiscard]] std::uint32_t first(const Aabb& box) const { return of(box.min[axis_]); }
  [[nodiscard]] std::uint32_t last(const Aabb& box) const { return of(box.max[axis_]); }
  /// The strip that reports the pair.
  [[nodiscard]] std::uint32_t reporting(const Aabb& a, const Aabb& b) const {
    return of(std::max(a.min[axis_], b.min[axis_]));
  }

 private:
  int axis_;
  double low_ = 0;
  double scale_ = 0;
  std::uint32_t count_ = 1;
};

/// The axes, longest extent of all boxes first.
std::array<int, 3> axesByExtent(std::span<const Aabb> boxes) {
  Aabb bounds = kEmptyBox;
  for (const Aabb& box : boxes) bounds = merged(bounds, box);  // an empty box changes nothing
  std::array<int, 3> axes = {0, 1, 2};
  std::ranges::stable_sort(axes, std::ranges::greater{}, [&](int axis) {
    return static_cast<double>(bounds.max[axis]) - bounds.min[axis];
  });
  return axes;
}

/// Contents of all strips: bodies of strip s at [start[s], start[s + 1]).
struct StripContents {
  std::vector<std::size_t> start;
  std::vector<std::uint32_t> bodies;
};

StripContents fill(const Strips& strips, std::span<const Aabb> boxes) {
  StripContents contents;
  contents.start.resize(strips.count() + 1);
  for (const Aabb& box : boxes) {
    if (isEmpty(box)) continue;
    for (auto s = strips.first(box); s <= strips.last(box); ++s) ++contents.start[s + 1];
  }
  std::partial_sum(contents.start.begin(), contents.start.end(), contents.start.begin());
  contents.bodies.resize(contents.start.back());
  std::vector<std::size_t> next(contents.start.begin(), contents.start.end() - 1);
  for (std::uint32_t body = 0; body < boxes.size(); ++body) {
    if (isEmpty(boxes[body])) continue;
    for (auto s = strips.first(boxes[body]); s <= strips.last(boxes[body]); ++s) {
      contents.bodies[next[s]++] = body;
    }
  }
  return contents;
}

[[noreturn]] void failTooMany(std::size_t max_pairs) {
  throw InputError(fmt::format("more than {} pairs overlap: too many to compute", max_pairs));
}

/// Ascending: a counting sort by the first bodies, then a sort of each body's pairs.
template <class Poll>
std::vector<Pair> sortedPairs(const std::vector<Pair>& pairs, std::size_t bodies, Poll& poll) {
  std::vector<std::size_t> start(bodies + 1);
  for (const Pair pair : pairs) ++start[pair.a + 1];
  std::partial_sum(start.begin(), start.end(), start.begin());
  std::vector<std::size_t> next(start.begin(), start.end() - 1);
  std::vector<Pair> sorted(pairs.size());
  for (const Pair pair : pairs) sorted[next[pair.a]++] = pair;
  for (std::size_t body = 0; body < bodies; ++body) {
    poll();
    std::sort(sorted.begin() + static_cast<std::ptrdiff_t>(start[body]),
              sorted.begin() + static_cast<std::ptrdiff_t>(start[body + 1]));
  }
  return sorted;
}

/// The pairs of all images: as those of more bodies, in a world that is not periodic.
std::vector<Pair> periodicPairs(std::span<const Aabb> boxes, const CollisionFilter& filter,
                                const PeriodicBox& periodic, std::size_t max_pairs,
                                const std::function<bool()>& cancelled) {
  std::vector<Aabb> images;
  std::vector<std::uint32_t> bodies;
  std::vector<unsigned> axes;  // along which an image lies lower
  for (std::uint32_t body = 0; body < boxes.size(); ++body) {
    const unsigned protruding = protrudingAxes(boxes[body], periodic);
    for (unsigned lower = 0; lower <= protruding; ++lower) {
      if ((lower & ~protruding) != 0) continue;
      images.push_back(image(boxes[body], lower, periodic));
      bodies.push_back(body);
      axes.push_back(lower);
    }
  }
  std::vector<Pair> pairs;
  for (const Pair found : sweptPairs(images, filter.of(bodies), {}, kUnlimitedPairs, cancelled)) {
    const Pair pair = orderedPair(bodies[found.a], bodies[found.b]);
    if (pair.a != pair.b && (axes[found.a] & axes[found.b]) == 0) pairs.push_back(pair);
  }
  std::ranges::sort(pairs);
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  if (pairs.size() > max_pairs) failTooMany(max_pairs);
  return pairs;
}

}  // namespace

PairDigest digest(PairRuns runs) {
  PairDigest result;
  for (const PairRun chunk : runs) {
    result.count += chunk.size();
    for (const Pair pair : chunk) result.hash += mixed(pair);
  }
  return result;
}

std::vector<Pair> bruteForcePairs(std::span<const Aabb> boxes, const CollisionFilter& filter,
                                  const PeriodicBox& periodic) {
  std::vector<Pair> pairs;
  const bool repeats = periodic.repeats();
  for (std::uint32_t a = 0; a < boxes.size(); ++a) {
    for (std::uint32_t b = a + 1; b < boxes.size(); ++b) {
      const bool found =
          repeats ? overlaps(boxes[a], boxes[b], periodic) : overlaps(boxes[a], boxes[b]);
      if (found && filter.wanted(a, b)) pairs.push_back({a, b});
    }
  }
  return pairs;
}

std::vector<Pair> sweptPairs(std::span<const Aabb> boxes, const CollisionFilter& filter,
                             const PeriodicBox& periodic, std::size_t max_pairs,
                             const std::function<bool()>& cancelled) {
  if (periodic.repeats()) return periodicPairs(boxes, filter, periodic, max_pairs, cancelled);
  auto poll = [&cancelled, steps = 0U]() mutable {
    constexpr unsigned kSteps = 64;
    if (cancelled && ++steps % kSteps == 0 && cancelled()) throw Cancelled();
  };
  std::vector<Pair> pairs;
  if (std::ranges::all_of(boxes, isEmpty)) return pairs;
  const std::array<int, 3> axes = axesByExtent(boxes);
  const int sweep_axis = axes[0];
  const Strips strips(boxes, axes[1]);
  StripContents contents = fill(strips, boxes);
  const std::span<const std::uint32_t> worlds = filter.worlds();
  const auto world_of = [&](std::uint32_t body) { return worlds.empty() ? 0 : worlds[body]; };

  for (std::uint32_t s = 0; s < strips.count(); ++s) {
    const std::span bodies(contents.bodies.data() + contents.start[s],
                           contents.start[s + 1] - contents.start[s]);
    std::ranges::sort(bodies, {}, [&](std::uint32_t body) {
      return std::pair(world_of(body), boxes[body].min[sweep_axis]);
    });
    for (auto i = bodies.begin(); i != bodies.end(); ++i) {
      poll();
      const Aabb& a = boxes[*i];
      for (auto j = i + 1; j != bodies.end() && world_of(*j) == world_of(*i) &&
                           boxes[*j].min[sweep_axis] <= a.max[sweep_axis];
           ++j) {
        if (overlaps(a, boxes[*j]) && strips.reporting(a, boxes[*j]) == s &&
            filter.wanted(*i, *j)) {
          if (pairs.size() == max_pairs) failTooMany(max_pairs);
          pairs.push_back(orderedPair(*i, *j));
        }
      }
    }
  }
  return sortedPairs(pairs, boxes.size(), poll);
}

}  // namespace broadmark
