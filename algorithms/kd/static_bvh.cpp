// Built once, top-down: bodies are split at the median of the longest axis until they fill a node.
// Nodes are stored without gaps and children without order, so that one vector operation per axis
// and side tests all children of a node.

#include "kd/static_bvh.h"

#include <algorithm>
#include <array>
#include <iterator>

#include "moments.h"

namespace broadmark::kd {
namespace {

/// Minimum number of static bodies per other body: below, a single tree for all bodies is faster.
constexpr std::size_t kMinStaticRatio = 4;

/// Splits at a multiple of the largest node size that is smaller than the range, so that all nodes
/// except the last one of a level are full.
std::size_t splitPosition(std::size_t count, std::size_t width) {
  std::size_t node = width;
  while (node * width < count) node *= width;
  const std::size_t nodes = (count + node - 1) / node;
  return nodes / 2 * node;
}

void sortIntoNodes(std::span<std::uint32_t> bodies, std::span<const Aabb> boxes,
                   std::size_t width) {
  if (bodies.size() <= width) return;
  std::array<double, 3> low = Moments::centre(boxes[bodies[0]]);
  std::array<double, 3> high = low;
  for (const std::uint32_t body : bodies) {
    const std::array<double, 3> centre = Moments::centre(boxes[body]);
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], centre[axis]);
      high[axis] = std::max(high[axis], centre[axis]);
    }
  }
  int longest = 0;
  for (const int axis : {1, 2}) {
    if (high[axis] - low[axis] > high[longest] - low[longest]) longest = axis;
  }
  const std::size_t split = splitPosition(bodies.size(), width);
  std::ranges::nth_element(bodies, bodies.begin() + static_cast<std::ptrdiff_t>(split), {},
                           [&](std::uint32_t body) { return centreOf(boxes[body], longest); });
  sortIntoNodes(bodies.first(split), boxes, width);
  sortIntoNodes(bodies.subspan(split), boxes, width);
}

}  // namespace

void StaticBvh::build(std::span<const Aabb> boxes, std::span<const std::uint32_t> bodies,
                      const CollisionFilter& filter, int workers) {
  const NonCollidingLayers layers(filter, bodies);
  if (layers.bodyCount() == 0 ||
      layers.bodyCount() < kMinStaticRatio * (bodies.size() - layers.bodyCount())) {
    return;
  }
  filter_ = filter;
  layers_ = layers;
  std::ranges::copy_if(bodies, std::back_inserter(bodies_),
                       [&](std::uint32_t body) { return layers.contains(filter.layerOf(body)); });
  sortIntoNodes(bodies_, boxes, kNodeWidth);
  index_of_.assign(boxes.size(), kInvalidIndex);
  std::vector<Aabb> level;
  for (const std::uint32_t body : bodies_) {
    index_of_[body] = static_cast<std::uint32_t>(level.size());
    level.push_back(boxes[body]);
  }
  // Spaced so that each worker writes to a cache line of its own.
  query_rows_ = kNodeWidth * static_cast<std::size_t>(workers);
  addLevel(level);
  while (level.size() > kNodeWidth) {
    level = parentBoxes(levels_.back());
    addLevel(level);
  }
}

void StaticBvh::addLevel(std::span<const Aabb> boxes) {
  BoxArrays& level = levels_.emplace_back();
  level.resize(query_rows_ + boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) level.set(query_rows_ + i, boxes[i]);
}

Range StaticBvh::childrenOf(const BoxArrays& level, std::size_t node) const {
  const std::size_t begin = query_rows_ + kNodeWidth * node;
  return {begin, std::min(begin + kNodeWidth, level.size())};
}

std::vector<Aabb> StaticBvh::parentBoxes(const BoxArrays& level) const {
  std::vector<Aabb> parents((level.size() - query_rows_ + kNodeWidth - 1) / kNodeWidth, kEmptyBox);
  for (std::size_t node = 0; node < parents.size(); ++node) {
    const Range range = childrenOf(level, node);
    for (std::size_t i = range.begin; i < range.end; ++i) {
      parents[node] = merged(parents[node], level.box(i));
    }
  }
  return parents;
}

/// The boxes of its ancestors are not refitted.
void StaticBvh::remove(std::uint32_t body) {
  levels_[0].set(query_rows_ + index_of_[body], kEmptyBox);
  index_of_[body] = kInvalidIndex;
}

/// Level by level: the hits of a level are the nodes to test on the next one.
void StaticBvh::query(std::uint32_t body, const Aabb& box, int worker,
                      const OverlapKernels& kernels, Scratch& scratch, PairBuffer& pairs) {
  const std::size_t row = kNodeWidth * static_cast<std::size_t>(worker);
  scratch.nodes.assign(1, 0);
  for (std::size_t depth = levels_.size(); depth-- > 0;) {
    BoxArrays& level = levels_[depth];
    level.set(row, box);
    scratch.hits.clear();
    for (const std::uint32_t node : scratch.nodes) {
      kernels.test_tile(level, {row, row + 1}, childrenOf(level, node), scratch.hits);
    }
    scratch.boxes_tested += kNodeWidth * scratch.nodes.size();
    scratch.nodes.clear();
    for (const Pair hit : scratch.hits.run()) {
      scratch.nodes.push_back(hit.b - static_cast<std::uint32_t>(query_rows_));
    }
  }
  for (const std::uint32_t index : scratch.nodes) {
    const std::uint32_t other = bodies_[index];
    // Infinite boxes overlap even the empty boxes of removed bodies.
    if (contains(other) && filter_.wanted(body, other)) pairs.add(body, other);
  }
}

std::string StaticBvh::validate(std::span<const Aabb> boxes) const {
  std::size_t present = 0;
  for (std::size_t index = 0; index < bodies_.size(); ++index) {
    if (!contains(bodies_[index])) continue;
    ++present;
    if (index_of_[bodies_[index]] != index) return "a static body has a wrong index";
    const Aabb& box = boxes[bodies_[index]];
    std::size_t i = index;
    for (const BoxArrays& level : levels_) {
      if (!broadmark::contains(level.box(query_rows_ + i), box)) {
        return "a static body is outside of its node";
      }
      i /= kNodeWidth;
    }
  }
  return present == size() ? "" : "the number of static bodies is wrong";
}

}  // namespace broadmark::kd
