// A bounding volume hierarchy with eight children to a node, over the boxes of the last update.
//
//   update         markDirty: changed bodies, up to a limit; beyond it, all
//   first query    build: split by the surface area heuristic, until eight bodies fit in a node
//   later queries  refresh: refit the dirty bodies' slots and the nodes above them; reinsert bodies
//                  that left their node's bounds; build if too many nodes have grown
//   batch          each worker answers a share; shares are concatenated
//
//   QueryNode, 256 bytes: eight slots                     slot_of_[body], parent_slots_[node]
//   +------------------------------------------+
//   | min x  0 1 2 3 4 5 6 7 | ... | max z 0-7 |   one vector comparison per bound tests all slots
//   | layers 0 1 2 3 4 5 6 7 | children 0-7    |   below a slot: a body, a node or nothing
//   +------------------------------------------+
//
// Answers are exact, whatever the shape of the tree: a slot of a body has its box, and the test of
// a slot is monotone in its bounds (query_math.h). They are sorted, so they do not depend on the
// shape.
//
// O(log n + k) for a query if boxes overlap little; O(n log n) to build, O(m log n) to refit m
// dirty bodies.
//
// Papers: I. Wald, C. Benthin, S. Boulos, "Getting Rid of Packets", 2008 (wide nodes); I. Wald, "On
// fast Construction of SAH-based Bounding Volume Hierarchies", 2007 (bins).

#include "queries/query_tree.h"

#include <algorithm>
#include <array>

#include "queries/query_parts.h"

namespace broadmark::broadphase {
namespace {

constexpr std::uint32_t kWidth = QueryNode::kWidth;

constexpr QueryNode kEmptyNode = [] {
  QueryNode node{};
  for (std::uint32_t slot = 0; slot < kWidth; ++slot) {
    for (int axis = 0; axis < 3; ++axis) {
      node.bounds[axis][slot] = QueryNode::kMax;
      node.bounds[axis + 3][slot] = -QueryNode::kMax;
    }
    node.children[slot] = QueryNode::kUnused;
  }
  return node;
}();

bool isBody(std::uint32_t child) {
  return (child & QueryNode::kBody) != 0 && child != QueryNode::kUnused;
}
bool isNode(std::uint32_t child) { return (child & QueryNode::kBody) == 0; }

/// An eighth of the sum of a box's edges: unlike a surface, not 0 for flat ones, and never
/// infinite. 0 for reversed bounds.
float sizeOf(const float (&bounds)[6]) {
  float size = 0;
  for (int axis = 0; axis < 3; ++axis) {
    size += std::max(bounds[axis + 3] * 0.125F - bounds[axis] * 0.125F, 0.0F);
  }
  return size;
}

}  // namespace

// Dirty bodies.

void QueryTree::markDirty(std::span<const Body> bodies) {
  if (all_dirty_) return;
  if (dirty_.size() + bodies.size() > dirty_limit_) {
    all_dirty_ = true;
  } else {
    dirty_.insert(dirty_.end(), bodies.begin(), bodies.end());
  }
}

void QueryTree::refresh(const QueryWorld& world, ThreadTeam& team) {
  if (is_built_ && dirty_.empty() && !all_dirty_) return;
  if (workers_.size() < static_cast<std::size_t>(team.size())) {
    workers_.resize(static_cast<std::size_t>(team.size()));
  }
  const bool can_refit = is_built_ && slot_of_.size() <= world.boxes.size();
  is_built_ = false;
  if (can_refit) {
    slot_of_.resize(world.boxes.size(), kNone);
    if (all_dirty_) {
      refitAll(world, team);
    } else {
      refitDirty(world);
    }
  }
  if (!can_refit || isDegraded(world.boxes.size())) build(world, team);
  dirty_limit_ = world.boxes.size() / 8 + 16;
  dirty_.clear();
  dirty_.reserve(dirty_limit_);
  all_dirty_ = false;
  is_built_ = true;
}

// Building.

void QueryTree::build(const QueryWorld& world, ThreadTeam& team) {
  items_.clear();
  for (Body body = 0; body < world.boxes.size(); ++body) {
    if (!isEmpty(world.boxes[body])) items_.push_back({world.boxes[body], body});
  }
  slot_of_.assign(world.boxes.size(), kNone);
  nodes_.clear();
  constexpr double kBuildNs = 200;  // for a body
  if (workersThatPay(kBuildNs * static_cast<double>(items_.size()), team.size()) > 1) {
    buildSubtrees(team);
  } else {
    buildNode(nodes_, partOf(items_), 0);
  }
  linkNodes();
  built_sizes_.assign(nodes_.size(), std::numeric_limits<float>::max());
  loose_nodes_ = 0;
  refitNodes(world, false, {0, nodes_.size()}, workers_[0]);
  for (NodeIndex node = 1; node < nodes_.size(); ++node) {
    built_sizes_[node] = sizeOf(extentIn(parent_slots_[node]).bounds);
  }
  built_nodes_ = nodes_.size();
  inserted_ = 0;
  loose_nodes_ = 0;
  too_deep_ = false;
}

QueryTree::NodeIndex QueryTree::buildNode(Nodes& nodes, const QueryPart& part,
                                          std::uint32_t depth) {
  /// Deeper, halves: a bad distribution may split off a few bodies at a time.
  constexpr std::uint32_t kMaxDepthByArea = 16;
  const auto index = static_cast<NodeIndex>(nodes.size());
  nodes.push_back(kEmptyNode);
  if (part.items.size() <= kWidth) {
    for (std::size_t i = 0; i < part.items.size(); ++i) {
      nodes[index].children[i] = part.items[i].body | QueryNode::kBody;
    }
    return index;
  }
  std::array<QueryPart, kWidth> parts;
  const std::size_t count = divide(part, depth < kMaxDepthByArea, parts);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t child = parts[i].items.size() == 1
                                    ? parts[i].items[0].body | QueryNode::kBody
                                    : buildNode(nodes, parts[i], depth + 1);
    nodes[index].children[i] = child;
  }
  return index;
}

/// The root's children in parallel.
void QueryTree::buildSubtrees(ThreadTeam& team) {
  std::array<QueryPart, kWidth> parts;
  std::array<NodeIndex, kWidth> roots;
  const std::size_t count = divide(partOf(items_), true, parts);
  team.run(count, [&](int worker, Range range) {
    Nodes& nodes = workers_[static_cast<std::size_t>(worker)].nodes;
    nodes.clear();
    for (std::size_t i = range.begin; i < range.end; ++i) {
      roots[i] = buildNode(nodes, parts[i], 1);
    }
  });
  nodes_.push_back(kEmptyNode);
  for (int worker = 0; worker < team.size(); ++worker) {
    const auto offset = static_cast<NodeIndex>(nodes_.size());
    for (QueryNode node : workers_[static_cast<std::size_t>(worker)].nodes) {
      for (std::uint32_t& child : node.children) child += isNode(child) ? offset : 0;
      nodes_.push_back(node);
    }
    const Range range = share(count, team.size(), worker);
    for (std::size_t i = range.begin; i < range.end; ++i) {
      nodes_[0].children[i] = roots[i] + offset;
    }
  }
}

/// Lets bodies and nodes find the slots that they are in.
void QueryTree::linkNodes() {
  parent_slots_.assign(nodes_.size(), kNone);
  for (SlotIndex slot = 0; slot < nodes_.size() * kWidth; ++slot) {
    const std::uint32_t child = nodes_[slot / kWidth].children[slot % kWidth];
    if (isBody(child)) {
      slot_of_[child & ~QueryNode::kBody] = slot;
    } else if (isNode(child)) {
      parent_slots_[child] = slot;
    }
  }
}

// Refitting.

QueryTree::Extent QueryTree::extentOf(NodeIndex node) const {
  const QueryNode& slots = nodes_[node];
  Extent extent{};
  for (int row = 0; row < 6; ++row) {
    float bound = slots.bounds[row][0];
    for (std::uint32_t slot = 1; slot < kWidth; ++slot) {
      const float other = slots.bounds[row][slot];
      bound = row < 3 ? std::min(bound, other) : std::max(bound, other);
    }
    extent.bounds[row] = bound;
  }
  for (const std::uint32_t layers : slots.layers) extent.layers |= layers;
  return extent;
}

QueryTree::Extent QueryTree::extentIn(SlotIndex slot) const {
  const QueryNode& node = nodes_[slot / kWidth];
  Extent extent{};
  for (int row = 0; row < 6; ++row) extent.bounds[row] = node.bounds[row][slot % kWidth];
  extent.layers = node.layers[slot % kWidth];
  return extent;
}

/// Whether a node has grown so much that its bodies no longer belong together.
bool QueryTree::isLoose(NodeIndex node, const Extent& extent) const {
  constexpr float kMaxGrowth = 1.5F;
  return sizeOf(extent.bounds) > kMaxGrowth * built_sizes_[node];
}

/// Stores a node's extent in its parent; returns the change in the number of loose nodes.
int QueryTree::storeExtent(NodeIndex node, const Extent& extent) {
  const SlotIndex slot = parent_slots_[node];
  const bool was_loose = isLoose(node, extentIn(slot));
  QueryNode& parent = nodes_[slot / kWidth];
  for (int row = 0; row < 6; ++row) parent.bounds[row][slot % kWidth] = extent.bounds[row];
  parent.layers[slot % kWidth] = extent.layers;
  return int{isLoose(node, extent)} - int{was_loose};
}

void QueryTree::setSlot(SlotIndex slot, const Aabb& box, std::uint32_t layers) {
  QueryNode& node = nodes_[slot / kWidth];
  for (std::size_t axis = 0; axis < 3; ++axis) {
    node.bounds[axis][slot % kWidth] = box.min[axis];
    node.bounds[axis + 3][slot % kWidth] = box.max[axis];
  }
  node.layers[slot % kWidth] = layers;
}

void QueryTree::placeBody(SlotIndex slot, Body body, const QueryWorld& world) {
  nodes_[slot / kWidth].children[slot % kWidth] = body | QueryNode::kBody;
  slot_of_[body] = slot;
  setSlot(slot, world.boxes[body], std::uint32_t{1} << world.filter.layerOf(body));
}

void QueryTree::clearSlot(SlotIndex slot) {
  QueryNode& node = nodes_[slot / kWidth];
  slot_of_[node.children[slot % kWidth] & ~QueryNode::kBody] = kNone;
  node.children[slot % kWidth] = QueryNode::kUnused;
  for (int row = 0; row < 6; ++row) {
    node.bounds[row][slot % kWidth] = row < 3 ? QueryNode::kMax : -QueryNode::kMax;
  }
  node.layers[slot % kWidth] = 0;
}

/// Whether a box is outside of the bounds that a node had after the last refresh.
bool QueryTree::hasEscaped(const Aabb& box, NodeIndex node) const {
  if (node == 0) return false;
  const Extent before = extentIn(parent_slots_[node]);
  bool escaped = false;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    escaped |= box.min[axis] > before.bounds[axis + 3] || box.max[axis] < before.bounds[axis];
  }
  return escaped;
}

/// Up to the first ancestor that stays as it is.
void QueryTree::refitParents(NodeIndex node) {
  for (; node != 0; node = parent_slots_[node] / kWidth) {
    const Extent now = extentOf(node);
    const Extent before = extentIn(parent_slots_[node]);
    if (std::ranges::equal(now.bounds, before.bounds) && now.layers == before.layers) return;
    loose_nodes_ += storeExtent(node, now);
  }
}

void QueryTree::refitDirty(const QueryWorld& world) {
  for (const Body body : dirty_) {
    const Aabb& box = world.boxes[body];
    const SlotIndex slot = slot_of_[body];
    if (slot != kNone) {
      const bool stays = !isEmpty(box) && !hasEscaped(box, slot / kWidth);
      if (stays) {
        placeBody(slot, body, world);
      } else {
        clearSlot(slot);
      }
      refitParents(slot / kWidth);
      if (stays) continue;
    }
    if (!isEmpty(box)) insert(body, world);
  }
}

/// Children before parents. A worker writes only to its nodes, and leaves parents among others' for
/// later.
void QueryTree::refitNodes(const QueryWorld& world, bool evicts, Range range, Worker& worker) {
  worker.postponed.clear();
  worker.loosened = 0;
  for (std::size_t i = range.end; i-- > range.begin;) {
    const auto node = static_cast<NodeIndex>(i);
    for (std::uint32_t k = 0; k < kWidth; ++k) {
      const std::uint32_t child = nodes_[node].children[k];
      if (!isBody(child)) continue;
      const Body body = child & ~QueryNode::kBody;
      const Aabb& box = world.boxes[body];
      if (isEmpty(box) || (evicts && hasEscaped(box, node))) {
        clearSlot(node * kWidth + k);
      } else {
        placeBody(node * kWidth + k, body, world);
      }
    }
    if (node == 0) continue;
    if (parent_slots_[node] / kWidth < range.begin) {
      worker.postponed.push_back(node);
    } else {
      worker.loosened += storeExtent(node, extentOf(node));
    }
  }
}

void QueryTree::refitAll(const QueryWorld& world, ThreadTeam& team) {
  constexpr double kRefitNs = 100;  // for a node
  const int workers = workersThatPay(kRefitNs * static_cast<double>(nodes_.size()), team.size());
  team.runOn(workers, [&](int worker) {
    refitNodes(world, true, share(nodes_.size(), workers, worker),
               workers_[static_cast<std::size_t>(worker)]);
  });
  for (int i = 0; i < workers; ++i) {
    const Worker& worker = workers_[static_cast<std::size_t>(i)];
    loose_nodes_ += worker.loosened;
    for (const NodeIndex node : worker.postponed) refitParents(node);
  }
  for (Body body = 0; body < world.boxes.size(); ++body) {
    if (slot_of_[body] != kNone || isEmpty(world.boxes[body])) continue;
    if (isDegraded(world.boxes.size())) return;
    insert(body, world);
  }
}

bool QueryTree::isDegraded(std::size_t bodies) const {
  return too_deep_ || inserted_ > bodies / 2 + 16 || nodes_.size() > 2 * built_nodes_ + 16 ||
         loose_nodes_ > static_cast<std::int64_t>(built_nodes_ / 4 + 2);
}

/// Descends to the child that grows least. Bodies of a full node get one of their own.
void QueryTree::insert(Body body, const QueryWorld& world) {
  const Aabb& box = world.boxes[body];
  NodeIndex node = 0;
  std::uint32_t depth = 0;
  while (true) {
    const auto growth = [&](std::uint32_t slot) {
      const Extent extent = extentIn(node * kWidth + slot);
      Bounds bounds;
      bounds.add(Corner{extent.bounds[0], extent.bounds[1], extent.bounds[2]},
                 Corner{extent.bounds[3], extent.bounds[4], extent.bounds[5]});
      const double before = extent.layers == 0 ? 0 : areaOf(bounds);
      bounds.add(minCorner(box), maxCorner(box));
      return areaOf(bounds) - before;
    };
    std::uint32_t unused = kNone;
    std::uint32_t nearest_node = kNone;
    std::uint32_t nearest_body = kNone;
    double least_for_node = 0;
    double least_for_body = 0;
    for (std::uint32_t slot = 0; slot < kWidth; ++slot) {
      const std::uint32_t child = nodes_[node].children[slot];
      if (child == QueryNode::kUnused) {
        unused = slot;
        continue;
      }
      std::uint32_t& nearest = isBody(child) ? nearest_body : nearest_node;
      double& least = isBody(child) ? least_for_body : least_for_node;
      const double area = growth(slot);
      if (nearest == kNone || area < least) nearest = slot, least = area;
    }
    if (nearest_node != kNone) {
      node = nodes_[node].children[nearest_node];
      ++depth;
      continue;
    }
    if (unused != kNone) {
      placeBody(node * kWidth + unused, body, world);
      break;
    }
    const auto added = static_cast<NodeIndex>(nodes_.size());
    const SlotIndex slot = node * kWidth + nearest_body;
    nodes_.push_back(kEmptyNode);
    parent_slots_.push_back(slot);
    built_sizes_.push_back(std::numeric_limits<float>::max());
    placeBody(added * kWidth, nodes_[node].children[nearest_body] & ~QueryNode::kBody, world);
    placeBody(added * kWidth + 1, body, world);
    nodes_[node].children[nearest_body] = added;
    const Extent extent = extentOf(added);
    storeExtent(added, extent);
    built_sizes_[added] = sizeOf(extent.bounds);
    too_deep_ |= depth + 1 >= QueryKernels::kMaxDepth;
    break;
  }
  ++inserted_;
  refitParents(node);
}

}  // namespace broadmark::broadphase
