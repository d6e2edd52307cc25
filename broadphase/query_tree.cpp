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

#include "query_tree.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <stdexcept>
#include <string>
#include <string_view>

#include "box_reader.h"
#include "corner.h"

namespace broadmark::broadphase {
namespace {

constexpr std::uint32_t kWidth = QueryNode::kWidth;

Corner minCorner(const Aabb& box) { return cornerOf(box.min); }
Corner maxCorner(const Aabb& box) { return cornerOf(box.max); }

/// The bounds of some boxes.
struct Bounds {
  Corner min = Corner{} + QueryNode::kMax;
  Corner max = Corner{} - QueryNode::kMax;

  void add(Corner other_min, Corner other_max) {
    min = smaller(min, other_min);
    max = larger(max, other_max);
  }
  void add(const Bounds& other) { add(other.min, other.max); }
};

/// Half the surface.
double areaOf(const Bounds& bounds) {
  std::array<double, 3> edges;
  for (int axis = 0; axis < 3; ++axis) {
    edges[axis] = static_cast<double>(bounds.max[axis]) - static_cast<double>(bounds.min[axis]);
  }
  return edges[0] * edges[1] + edges[1] * edges[2] + edges[2] * edges[0];
}

/// Twice the centre may overflow.
Corner centreOf(const Aabb& box) { return minCorner(box) * 0.5F + maxCorner(box) * 0.5F; }

}  // namespace

/// Some items, with the bounds of their boxes and of the centres of these.
struct QueryPart {
  std::span<QueryItem> items;
  Bounds bounds;
  Bounds centres;

  void add(const QueryItem& item) {
    const Corner centre = centreOf(item.box);
    bounds.add(minCorner(item.box), maxCorner(item.box));
    centres.add(centre, centre);
  }
  void add(const QueryPart& other) {
    bounds.add(other.bounds);
    centres.add(other.centres);
  }
};

namespace {

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

QueryPart partOf(std::span<QueryItem> items) {
  QueryPart part{items, {}, {}};
  for (const QueryItem& item : items) part.add(item);
  return part;
}

/// Divides a part into up to eight, until they fit in nodes; returns their number. `by_area`: else
/// into halves, in any order.
std::size_t divide(const QueryPart& whole, bool by_area, std::array<QueryPart, kWidth>& parts) {
  parts[0] = whole;
  std::size_t count = 1;
  while (count < kWidth) {
    std::size_t largest = count;
    double largest_area = -1;
    for (std::size_t i = 0; i < count; ++i) {
      const double area = by_area ? areaOf(parts[i].bounds) : double(parts[i].items.size());
      if (parts[i].items.size() <= kWidth || area <= largest_area) continue;
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
  if (team.size() > 1 && items_.size() > kWidth) {
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
  team.run(nodes_.size(), [&](int worker, Range range) {
    refitNodes(world, true, range, workers_[static_cast<std::size_t>(worker)]);
  });
  for (int i = 0; i < team.size(); ++i) {
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

// Queries.

namespace {

[[noreturn, gnu::cold]] void refuse(std::size_t query, std::string_view fault) {
  throw std::invalid_argument(
      std::string("query ").append(std::to_string(query)).append(": ").append(fault));
}

void check(std::size_t number, const Box& box) {
  const Aabb checked = BoxReader(box.min, box.max, 0, 0).raw(0);
  if (!isFiniteBox(checked)) refuse(number, faultOf(checked));
}

void check(std::size_t number, const float (&vector)[3], std::string_view fault) {
  for (const float x : vector) {
    if (!std::isfinite(x)) refuse(number, fault);
  }
}

void check(std::size_t number, float limit, std::string_view fault) {
  if (!(limit >= 0)) refuse(number, fault);
}

}  // namespace

void checkQueries(std::span<const BoxQuery> queries) {
  for (std::size_t i = 0; i < queries.size(); ++i) check(i, queries[i].box);
}
void checkQueries(std::span<const Cast> casts) {
  for (std::size_t i = 0; i < casts.size(); ++i) {
    check(i, casts[i].box);
    check(i, casts[i].direction, "direction is not finite");
    check(i, casts[i].max_fraction, "max_fraction is negative or NaN");
  }
}
void checkQueries(std::span<const NearestQuery> queries) {
  for (std::size_t i = 0; i < queries.size(); ++i) {
    check(i, queries[i].point, "point is not finite");
    check(i, queries[i].max_distance, "max_distance is negative or NaN");
  }
}

template <class Query, class T, class Answer>
void QueryTree::answerAll(std::span<const Query> queries, QueryResults<T>& results,
                          std::vector<T> Worker::*found, ThreadTeam& team, Answer answer) {
  constexpr std::size_t kMinQueriesForThreads = 64;
  results.items.clear();
  results.starts.resize(queries.size() + 1);
  const auto answer_range = [&](int worker, Range range) {
    std::vector<T>& items =
        worker == 0 ? results.items : workers_[static_cast<std::size_t>(worker)].*found;
    items.clear();
    for (std::size_t i = range.begin; i < range.end; ++i) {
      results.starts[i] = items.size();
      answer(queries[i], items);
    }
  };
  const int workers = queries.size() < kMinQueriesForThreads ? 1 : team.size();
  if (workers == 1) {
    answer_range(0, {0, queries.size()});
  } else {
    team.run(queries.size(), answer_range);
  }
  for (int worker = 1; worker < workers; ++worker) {
    const std::vector<T>& items = workers_[static_cast<std::size_t>(worker)].*found;
    const Range range = share(queries.size(), workers, worker);
    const std::size_t first = results.items.size();
    for (std::size_t i = range.begin; i < range.end; ++i) results.starts[i] += first;
    results.items.insert(results.items.end(), items.begin(), items.end());
  }
  results.starts[queries.size()] = results.items.size();
}

namespace {

/// Calls visit(body, slot) for each.
template <class Visit>
void forEachBody(const QueryNode& node, unsigned slots, Visit visit) {
  for (; slots != 0; slots &= slots - 1) {
    const int slot = std::countr_zero(slots);
    visit(node.children[slot] & ~QueryNode::kBody, slot);
  }
}

void addBodies(void* context, const QueryNode& node, unsigned slots) {
  auto& bodies = *static_cast<std::vector<std::uint32_t>*>(context);
  forEachBody(node, slots, [&](std::uint32_t body, int) { bodies.push_back(body); });
}

struct HitCollector {
  double max_fraction;
  double limit;
  std::size_t first;
  std::vector<CastHit>& hits;

  [[nodiscard]] CastHit hitOf(std::uint32_t body, double time) const {
    return {smallerOf(time, max_fraction) + 0.0, body};  // no -0
  }
};

double addHits(void* context, const QueryNode& node, unsigned slots, const double* times) {
  auto& collector = *static_cast<HitCollector*>(context);
  forEachBody(node, slots, [&](std::uint32_t body, int slot) {
    collector.hits.push_back(collector.hitOf(body, times[slot]));
  });
  return collector.limit;
}

double keepClosest(void* context, const QueryNode& node, unsigned slots, const double* times) {
  auto& collector = *static_cast<HitCollector*>(context);
  forEachBody(node, slots, [&](std::uint32_t body, int slot) {
    const CastHit hit = collector.hitOf(body, times[slot]);
    if (collector.hits.size() == collector.first) {
      collector.hits.push_back(hit);
    } else {
      collector.hits.back() = std::min(collector.hits.back(), hit);
    }
  });
  const double closest = collector.hits.back().fraction;
  return closest < collector.max_fraction ? closest : collector.limit;
}

/// Keeps the nearest bodies as a heap, the farthest first. Their distances are still squared.
struct NeighbourHeap {
  double limit;
  std::size_t first;
  std::size_t count;
  std::vector<Neighbour>& neighbours;

  static bool isNearer(const Neighbour& a, const Neighbour& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.body < b.body;
  }
  [[nodiscard]] std::span<Neighbour> heap() const { return std::span(neighbours).subspan(first); }

  void add(const Neighbour& neighbour) {
    if (heap().size() == count) {
      if (!isNearer(neighbour, heap().front())) return;
      std::ranges::pop_heap(heap(), isNearer);
      neighbours.back() = neighbour;
    } else {
      neighbours.push_back(neighbour);
    }
    std::ranges::push_heap(heap(), isNearer);
    if (heap().size() == count) limit = heap().front().distance;
  }
};

double addNeighbours(void* context, const QueryNode& node, unsigned slots, const double* squares) {
  auto& heap = *static_cast<NeighbourHeap*>(context);
  forEachBody(node, slots, [&](std::uint32_t body, int slot) { heap.add({squares[slot], body}); });
  return heap.limit;
}

}  // namespace

void QueryTree::overlapping(std::span<const BoxQuery> queries, QueryResults<Body>& results,
                            ThreadTeam& team) {
  answerAll(queries, results, &Worker::bodies, team,
            [this](const BoxQuery& query, std::vector<Body>& bodies) {
              BoxTest test;
              std::ranges::copy(query.box.min, test.bounds);
              std::ranges::copy(query.box.max, test.bounds + 3);
              test.layers = query.layers;
              const auto first = static_cast<std::ptrdiff_t>(bodies.size());
              kernels_.overlapping(nodes_.data(), test, {addBodies, &bodies});
              std::ranges::sort(bodies.begin() + first, bodies.end());
            });
}

void QueryTree::cast(std::span<const Cast> casts, Hits wanted, QueryResults<CastHit>& results,
                     ThreadTeam& team) {
  answerAll(casts, results, &Worker::hits, team,
            [this, wanted](const Cast& cast, std::vector<CastHit>& hits) {
              CastTest test;
              for (std::size_t axis = 0; axis < 3; ++axis) {
                test.axes[axis] =
                    CastAxis(cast.box.min[axis], cast.box.max[axis], cast.direction[axis]);
                test.near_rows[axis] = test.axes[axis].backwards ? axis + 3 : axis;
                test.far_rows[axis] = test.axes[axis].backwards ? axis : axis + 3;
              }
              test.limit = castLimit(cast.max_fraction);
              test.layers = cast.layers;
              HitCollector collector = {cast.max_fraction, test.limit, hits.size(), hits};
              const auto first = static_cast<std::ptrdiff_t>(hits.size());
              kernels_.cast(nodes_.data(), test,
                            {wanted == Hits::closest ? keepClosest : addHits, &collector});
              std::ranges::sort(hits.begin() + first, hits.end());
            });
}

void QueryTree::nearest(std::span<const NearestQuery> queries, QueryResults<Neighbour>& results,
                        ThreadTeam& team) {
  answerAll(queries, results, &Worker::neighbours, team,
            [this](const NearestQuery& query, std::vector<Neighbour>& neighbours) {
              if (query.count == 0) return;
              NearestTest test;
              std::ranges::copy(query.point, test.point);
              test.limit = squaredLimit(query.max_distance);
              test.layers = query.layers;
              NeighbourHeap heap = {test.limit, neighbours.size(), query.count, neighbours};
              kernels_.nearest(nodes_.data(), test, {addNeighbours, &heap});
              std::ranges::sort_heap(heap.heap(), NeighbourHeap::isNearer);
              for (Neighbour& neighbour : heap.heap()) {
                neighbour.distance = std::sqrt(neighbour.distance);
              }
            });
}

}  // namespace broadmark::broadphase
