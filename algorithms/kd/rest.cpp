// A tree of boxes with sixteen children to a node, packed once: bodies are put into an order in
// which each node's lie together, by halving them at the median of the axis on which they extend
// furthest. Without order among children, and with no room for more, a node is one vector test for
// each axis and side.

#include "kd/rest.h"

#include <algorithm>
#include <array>
#include <iterator>

#include "moments.h"

namespace broadmark::kd {
namespace {

/// Worth it where there are so many for each of the others: else one tree for all is quicker.
constexpr std::size_t kMost = 4;

/// The number of bodies in the first half: whole nodes, of the largest kind that there is more than
/// one of.
std::size_t firstHalf(std::size_t count, std::size_t block) {
  std::size_t node = block;
  while (node * block < count) node *= block;
  const std::size_t nodes = (count + node - 1) / node;
  return nodes / 2 * node;
}

void putInOrder(std::span<std::uint32_t> bodies, std::span<const Aabb> boxes, std::size_t block) {
  if (bodies.size() <= block) return;
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
  const std::size_t half = firstHalf(bodies.size(), block);
  std::ranges::nth_element(bodies, bodies.begin() + static_cast<std::ptrdiff_t>(half), {},
                           [&](std::uint32_t body) { return centreOf(boxes[body], longest); });
  putInOrder(bodies.first(half), boxes, block);
  putInOrder(bodies.subspan(half), boxes, block);
}

}  // namespace

void Rest::build(std::span<const Aabb> boxes, std::span<const std::uint32_t> bodies,
                 const CollisionFilter& filter, int workers) {
  const Strangers strangers(filter, bodies);
  if (strangers.count() == 0 || strangers.count() < kMost * (bodies.size() - strangers.count())) {
    return;
  }
  filter_ = filter;
  strangers_ = strangers;
  std::ranges::copy_if(bodies, std::back_inserter(bodies_),
                       [&](std::uint32_t body) { return strangers.contains(body); });
  putInOrder(bodies_, boxes, kBlock);
  places_.assign(boxes.size(), kNowhere);
  std::vector<Aabb> level;
  for (const std::uint32_t body : bodies_) {
    places_[body] = static_cast<std::uint32_t>(level.size());
    level.push_back(boxes[body]);
  }
  // Each worker writes to a cache line of its own.
  first_ = kBlock * static_cast<std::size_t>(workers);
  addLevel(level);
  while (level.size() > kBlock) {
    level = blockBoxes(levels_.back());
    addLevel(level);
  }
}

void Rest::addLevel(std::span<const Aabb> boxes) {
  BoxArrays& level = levels_.emplace_back();
  level.resize(first_ + boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) level.set(first_ + i, boxes[i]);
}

Range Rest::blockAt(const BoxArrays& level, std::size_t block) const {
  const std::size_t begin = first_ + kBlock * block;
  return {begin, std::min(begin + kBlock, level.size())};
}

std::vector<Aabb> Rest::blockBoxes(const BoxArrays& level) const {
  std::vector<Aabb> around((level.size() - first_ + kBlock - 1) / kBlock, kEmptyBox);
  for (std::size_t block = 0; block < around.size(); ++block) {
    const Range range = blockAt(level, block);
    for (std::size_t i = range.begin; i < range.end; ++i) {
      around[block] = merged(around[block], level.box(i));
    }
  }
  return around;
}

/// The boxes around it stay as large as they were.
void Rest::remove(std::uint32_t body) {
  levels_[0].set(first_ + places_[body], kEmptyBox);
  places_[body] = kNowhere;
}

void Rest::search(std::uint32_t body, const Aabb& box, int worker, const OverlapKernels& kernels,
                  Scratch& scratch, PairBuffer& pairs) {
  const std::size_t row = kBlock * static_cast<std::size_t>(worker);
  scratch.blocks.assign(1, 0);
  for (std::size_t depth = levels_.size(); depth-- > 0;) {
    BoxArrays& level = levels_[depth];
    level.set(row, box);
    scratch.hits.clear();
    for (const std::uint32_t block : scratch.blocks) {
      kernels.test_tile(level, {row, row + 1}, blockAt(level, block), scratch.hits);
    }
    scratch.boxes_tested += kBlock * scratch.blocks.size();
    scratch.blocks.clear();
    for (const Pair hit : scratch.hits.run()) {
      scratch.blocks.push_back(hit.b - static_cast<std::uint32_t>(first_));
    }
  }
  for (const std::uint32_t place : scratch.blocks) {
    const std::uint32_t other = bodies_[place];
    // Infinite boxes overlap even the empty ones of bodies that were taken out.
    if (holds(other) && filter_.wanted(body, other)) pairs.add(body, other);
  }
}

std::string Rest::validate(std::span<const Aabb> boxes) const {
  std::size_t held = 0;
  for (std::size_t place = 0; place < bodies_.size(); ++place) {
    if (!holds(bodies_[place])) continue;
    ++held;
    if (places_[bodies_[place]] != place) return "a body at rest is taken to be elsewhere";
    const Aabb& box = boxes[bodies_[place]];
    std::size_t i = place;
    for (const BoxArrays& level : levels_) {
      if (!contains(level.box(first_ + i), box)) return "a body at rest is outside of its node";
      i /= kBlock;
    }
  }
  return held == size() ? "" : "bodies at rest are miscounted";
}

}  // namespace broadmark::kd
