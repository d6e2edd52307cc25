#include "queries/query_parts.h"

#include <algorithm>

namespace broadmark::broadphase {
namespace {

/// Splits a part in two by the surface area heuristic.
class Splitter {
 public:
  explicit Splitter(const QueryPart& part)
      : bin_count_(std::clamp<std::size_t>(part.items.size() / 4, 4, kMaxBins)) {
    for (int axis = 0; axis < 3; ++axis) {
      const double extent = double{part.centres.max[axis]} - double{part.centres.min[axis]};
      if (extent > extent_) extent_ = extent, axis_ = axis;
    }
    origin_ = part.centres.min[axis_];
    scale_ = static_cast<double>(bin_count_) * (1 - 1e-9) / extent_;
  }

  /// Whether the centres differ.
  [[nodiscard]] bool canSplit() const { return extent_ > 0; }

  [[nodiscard]] std::array<QueryPart, 2> split(const QueryPart& part) {
    for (const QueryItem& item : part.items) {
      Bin& bin = bins_[binOf(item)];
      bin.part.add(item);
      ++bin.count;
    }
    const std::size_t first_above = bestSplit(part.items.size());
    const auto above =
        std::partition(part.items.begin(), part.items.end(),
                       [&](const QueryItem& item) { return binOf(item) < first_above; });
    std::array<QueryPart, 2> halves = {QueryPart{{part.items.begin(), above}, {}, {}},
                                       QueryPart{{above, part.items.end()}, {}, {}}};
    for (std::size_t bin = 0; bin < bin_count_; ++bin) {
      halves[bin < first_above ? 0 : 1].add(bins_[bin].part);
    }
    return halves;
  }

 private:
  static constexpr std::size_t kMaxBins = 16;

  struct Bin {
    QueryPart part;
    std::size_t count = 0;
  };

  [[nodiscard]] std::size_t binOf(const QueryItem& item) const {
    return static_cast<std::size_t>((double{centreOf(item.box)[axis_]} - origin_) * scale_);
  }

  /// The first bin above the split; the first and the last bin are not empty.
  [[nodiscard]] std::size_t bestSplit(std::size_t count) const {
    double costs_above[kMaxBins];
    Bounds bounds;
    std::size_t above = 0;
    for (std::size_t bin = bin_count_; bin-- > 1;) {
      bounds.add(bins_[bin].part.bounds);
      above += bins_[bin].count;
      costs_above[bin] = areaOf(bounds) * static_cast<double>(above);
    }
    bounds = {};
    std::size_t best = 0;
    std::size_t best_imbalance = 0;
    double best_cost = 0;
    std::size_t below = 0;
    for (std::size_t bin = 1; bin < bin_count_; ++bin) {
      bounds.add(bins_[bin - 1].part.bounds);
      below += bins_[bin - 1].count;
      const double cost = areaOf(bounds) * static_cast<double>(below) + costs_above[bin];
      const std::size_t imbalance = std::max(below, count - below);  // all areas may be 0
      if (best == 0 || cost < best_cost || (cost == best_cost && imbalance < best_imbalance)) {
        best = bin;
        best_cost = cost;
        best_imbalance = imbalance;
      }
    }
    return best;
  }

  std::size_t bin_count_;
  int axis_ = 0;
  double extent_ = 0;
  double origin_ = 0;
  double scale_ = 0;
  Bin bins_[kMaxBins];
};

}  // namespace

QueryPart partOf(std::span<QueryItem> items) {
  QueryPart part{items, {}, {}};
  for (const QueryItem& item : items) part.add(item);
  return part;
}

std::size_t divide(const QueryPart& whole, bool by_area,
                   std::array<QueryPart, QueryNode::kWidth>& parts) {
  parts[0] = whole;
  std::size_t count = 1;
  while (count < QueryNode::kWidth) {
    std::size_t largest = count;
    double largest_area = -1;
    for (std::size_t i = 0; i < count; ++i) {
      const double area = by_area ? areaOf(parts[i].bounds) : double(parts[i].items.size());
      if (parts[i].items.size() <= QueryNode::kWidth || area <= largest_area) continue;
      largest = i;
      largest_area = area;
    }
    if (largest == count) break;
    QueryPart& part = parts[largest];
    Splitter splitter(part);
    if (by_area && splitter.canSplit()) {
      const auto halves = splitter.split(part);
      part = halves[0];
      parts[count++] = halves[1];
    } else {
      const std::size_t middle = part.items.size() / 2;
      parts[count++] = partOf(part.items.subspan(middle));
      part = partOf(part.items.first(middle));
    }
  }
  return count;
}

}  // namespace broadmark::broadphase
