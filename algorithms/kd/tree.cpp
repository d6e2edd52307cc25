// An update makes two passes over the dirty part of the tree.
//
// Bottom-up, refit: a node evicts bodies that no longer fit in its cell to the own bodies of its
// parent. Within the parent's slice they only swap with the subtree in between.
//
// Top-down, restructure: own bodies that no longer straddle the plane move to the child on their
// side (waterfall). A node with too few bodies or an empty child becomes a leaf (trim). A node with
// a poor split gets its plane moved to the mean centre of its bodies (translate) or, if that does
// not help, is replaced by its larger child (erase). A leaf with too many bodies is split
// (partition).
//
// Both passes test only bodies that moved or were inserted, except in nodes with a new plane or
// cell.
//
// In parallel, subtrees with disjoint slices are independent tasks. One worker handles the nodes
// above them: after the first pass and before the second.

#include "kd/tree.h"

#include <algorithm>
#include <atomic>
#include <functional>
#include <utility>

#include "moments.h"

namespace broadmark::kd {
namespace {

constexpr std::size_t kTasksPerWorker = 8;

/// Updates `dirty` and `work` bottom-up.
void sumWork(Node& node) {
  if (!node.dirty) return;
  node.dirty = node.own_dirty;
  node.work = node.own_dirty ? node.own : 0;
  if (node.isLeaf()) return;
  for (Node* child : {&node.left(), &node.right()}) {
    sumWork(*child);
    node.dirty |= child->dirty;
    node.work += child->work;
  }
}

void markAllDirty(Node& node) {
  node.own_dirty = node.dirty = true;
  if (node.isLeaf()) return;
  markAllDirty(node.left());
  markAllDirty(node.right());
}

void clearDirty(Node& node) {
  if (!node.dirty) return;
  node.own_dirty = node.dirty = false;
  node.work = 0;
  if (node.isLeaf()) return;
  clearDirty(node.left());
  clearDirty(node.right());
}

}  // namespace

void Tree::build(std::span<const Aabb> boxes, std::span<const std::uint8_t> moved,
                 std::span<const std::uint32_t> bodies, std::size_t objects_per_leaf,
                 ThreadTeam& team) {
  boxes_ = boxes;
  moved_ = moved;
  objects_per_leaf_ = objects_per_leaf;
  team_ = &team;
  workers_.resize(static_cast<std::size_t>(team.size()));
  if (!root_.isLeaf()) nodes_.releaseChildren(root_);
  root_ = {};
  bodies_.clear();
  bodies_.reserve(boxes.size());
  node_of_.assign(boxes.size(), nullptr);
  beginUpdate(true);
  insert(bodies);
  update();
}

void Tree::beginUpdate(bool all) {
  for (Worker& worker : workers_) worker.counts = {};
  all ? markAllDirty(root_) : clearDirty(root_);
}

void Tree::markDirty(std::uint32_t body) {
  // Test before the store: a flag that is already set stays shared between the caches.
  const auto set = [](bool& flag) {
    const std::atomic_ref<bool> shared(flag);
    const bool before = shared.load(std::memory_order_relaxed);
    if (!before) shared.store(true, std::memory_order_relaxed);
    return !before;
  };
  Node* node = node_of_[body];
  set(node->own_dirty);
  while (node != nullptr && set(node->dirty)) node = node->parent;
}

void Tree::insert(std::span<const std::uint32_t> bodies) {
  if (bodies.empty()) return;
  bodies_.insert(bodies_.end(), bodies.begin(), bodies.end());
  appendTo(root_, 0, bodies.size(), workers_[0]);
}

void Tree::update() {
  nodes_.reserve();
  const std::size_t parts = team_->size() == 1 ? 1 : workers_.size() * kTasksPerWorker;
  task_size_ = bodies_.size() / parts;
  refitAll();
  removeAbsent();
  restructureAll();
  sumWork(root_);
}

Tree::NodeContext Tree::leftContext(const Node& node, const NodeContext& context) {
  NodeContext left = {context.begin, Side::left, context.cell};
  // The plane may have been moved outside of the cell.
  left.cell.hi[node.axis] = std::min(left.cell.hi[node.axis], node.plane);
  return left;
}

Tree::NodeContext Tree::rightContext(const Node& node, const NodeContext& context) {
  const std::size_t begin = context.begin + node.left().size + node.left().evicted + node.own;
  NodeContext right = {begin, Side::right, context.cell};
  right.cell.lo[node.axis] = std::max(right.cell.lo[node.axis], node.plane);
  return right;
}

/// Whether cost <= balance. The cost is the number of pairs left to test, scaled to 0 for two equal
/// halves and 1 for no split. The balance is 1 for equal children without straddling bodies, 0 for
/// an empty child.
bool Tree::isGoodSplit(const SideCounts& sides) {
  const auto own = static_cast<double>(sides.own);
  const auto left = static_cast<double>(sides.left);
  const auto right = static_cast<double>(sides.right);
  const double total = own + left + right;
  const double pairs = (own * own + left * left + right * right - total) / 2 + own * (left + right);
  const double min_pairs = (total / 2) * (total / 2) - total / 2;
  const double max_pairs = (total * total - total) / 2;
  const double balance = std::min(left, right) / (std::max(left, right) + own);
  return pairs - min_pairs <= balance * (max_pairs - min_pairs);
}

Tree::SideCounts Tree::countSides(std::span<const std::uint32_t> bodies, int axis,
                                  float plane) const {
  SideCounts sides;
  for (const std::uint32_t body : bodies) {
    sides.left += isLeft(boxes_[body], axis, plane);
    sides.right += isRight(boxes_[body], axis, plane);
  }
  sides.own = bodies.size() - sides.left - sides.right;
  return sides;
}

/// Each worker gets consecutive tasks with about the same number of bodies.
template <class Work>
void Tree::runTasks(Work work) {
  std::size_t total = 0;
  for (const Task& task : tasks_) total += task.node->dirty ? task.node->size : 0;
  total = std::max<std::size_t>(total, 1);
  // In advance, since the tasks change the sizes.
  for (std::size_t before = 0; Task & task : tasks_) {
    task.worker = std::min(before * workers_.size() / total, workers_.size() - 1);
    before += task.node->dirty ? task.node->size : 0;
  }
  team_->run([&](int worker) {
    for (const Task& task : tasks_) {
      if (task.worker == static_cast<std::size_t>(worker)) work(task, workers_[task.worker]);
    }
  });
}

void Tree::refitAll() {
  tasks_.clear();
  collectTasks(root_, {});
  runTasks([this](const Task& task, Worker& worker) {
    refit(*task.node, task.context, Scope::dirty, worker);
    task.node->refitted = true;
  });
  if (!root_.refitted) refit(root_, {}, Scope::dirty, workers_[0]);
  for (const Task& task : tasks_) task.node->refitted = false;
}

void Tree::collectTasks(Node& node, const NodeContext& context) {
  if (node.isLeaf() || node.size <= task_size_) {
    tasks_.push_back({&node, context});
    return;
  }
  collectTasks(node.left(), leftContext(node, context));
  collectTasks(node.right(), rightContext(node, context));
}

void Tree::refit(Node& node, const NodeContext& context, Scope scope, Worker& worker) {
  if (!node.dirty && scope == Scope::dirty) {
    ++worker.counts[skipped_subtrees];
    return;
  }
  if (!node.isLeaf()) {
    const NodeContext left = leftContext(node, context);
    const NodeContext right = rightContext(node, context);
    if (!node.left().refitted) refit(node.left(), left, scope, worker);
    if (!node.right().refitted) refit(node.right(), right, scope, worker);
    adopt(node, context, worker);
  }
  if (context.side != Side::root && (node.own_dirty || scope == Scope::all)) {
    evict(node, context, scope, worker);
  }
}

/// The slice is: left's | evicted from left | own | evicted from right | right's. Everything
/// between left and right becomes own.
void Tree::adopt(Node& node, const NodeContext& context, Worker& worker) {
  const std::uint32_t from_left = std::exchange(node.left().evicted, 0);
  const std::uint32_t from_right = std::exchange(node.right().evicted, 0);
  const std::size_t begin = context.begin + node.left().size;
  addToOwn(node, begin, from_left, worker);
  addToOwn(node, begin + node.own, from_right, worker);
}

void Tree::evict(Node& node, const NodeContext& context, Scope scope, Worker& worker) {
  const auto fits = [&](std::uint32_t body) {
    return (scope == Scope::dirty && moved_[body] == 0) || context.cell.contains(boxes_[body]);
  };
  const std::size_t left_size = node.isLeaf() ? 0 : node.left().size;
  const std::size_t begin = context.begin + left_size;
  const std::size_t end = begin + node.own;
  std::size_t evicted = 0;
  if (context.side == Side::left) {
    const auto middle = std::partition(bodyAt(begin), bodyAt(end), fits);
    evicted = static_cast<std::size_t>(bodyAt(end) - middle);
    swapBlocks(end - evicted, end, context.begin + node.size, worker);
  } else {
    const auto middle = std::partition(bodyAt(begin), bodyAt(end), std::not_fn(fits));
    evicted = static_cast<std::size_t>(middle - bodyAt(begin));
    swapBlocks(context.begin, begin, begin + evicted, worker);
  }
  if (evicted == 0) return;
  node.evicted = static_cast<std::uint32_t>(evicted);
  node.own -= node.evicted;
  node.size -= node.evicted;
  node.own_dirty = node.dirty = true;
}

/// No cell contains the box kAbsent: the refit has evicted all absent bodies to the root.
void Tree::removeAbsent() {
  if (!root_.own_dirty) return;
  const std::size_t begin = root_.isLeaf() ? 0 : root_.left().size;
  const std::size_t end = begin + root_.own;
  std::uint32_t* const absent = std::partition(
      bodyAt(begin), bodyAt(end),
      [this](std::uint32_t body) { return moved_[body] == 0 || boxes_[body] != kAbsent; });
  const auto count = static_cast<std::uint32_t>(bodyAt(end) - absent);
  if (count == 0) return;
  for (const std::uint32_t* body = absent; body != bodyAt(end); ++body) node_of_[*body] = nullptr;
  swapBlocks(end - count, end, bodies_.size(), workers_[0]);
  bodies_.resize(bodies_.size() - count);
  root_.own -= count;
  root_.size -= count;
}

void Tree::restructureAll() {
  tasks_.clear();
  restructure(root_, {}, workers_[0], true);
  runTasks([this](const Task& task, Worker& worker) {
    restructure(*task.node, task.context, worker, false);
  });
}

/// `defer_small`: small subtrees become tasks instead.
void Tree::restructure(Node& node, const NodeContext& context, Worker& worker, bool defer_small) {
  if (!node.dirty) {
    ++worker.counts[skipped_subtrees];
    return;
  }
  if (defer_small && node.size <= task_size_) {
    tasks_.push_back({&node, context});
    return;
  }
  // Terminates: a partition yields a good split, an erasure reduces the number of nodes, and a
  // translation is applied only if it yields a good split.
  while (!node.isLeaf() || partition(node, context, worker)) {
    waterfall(node, context, worker);
    const SideCounts sides = {node.own, node.left().size, node.right().size};
    if (node.size < objects_per_leaf_ || sides.left == 0 || sides.right == 0) {
      trim(node, context, worker);
    } else if (isGoodSplit(sides)) {
      restructure(node.left(), leftContext(node, context), worker, defer_small);
      restructure(node.right(), rightContext(node, context), worker, defer_small);
      return;
    } else if (!translate(node, context, worker)) {
      erase(node, context, worker);
    }
  }
}

void Tree::waterfall(Node& node, const NodeContext& context, Worker& worker) {
  if (!node.own_dirty) return;
  const bool all = std::exchange(node.check_all, false);
  const auto is_checked = [&](std::uint32_t body) { return all || moved_[body] != 0; };
  const auto is_left = [&](std::uint32_t body) {
    return is_checked(body) && isLeft(boxes_[body], node.axis, node.plane);
  };
  const auto is_not_right = [&](std::uint32_t body) {
    return !is_checked(body) || !isRight(boxes_[body], node.axis, node.plane);
  };
  const std::size_t begin = context.begin + node.left().size;
  const std::size_t end = begin + node.own;
  std::uint32_t* const stay = std::partition(bodyAt(begin), bodyAt(end), is_left);
  std::uint32_t* const right = std::partition(stay, bodyAt(end), is_not_right);
  node.own = static_cast<std::uint32_t>(right - stay);
  appendTo(node.left(), context.begin, static_cast<std::size_t>(stay - bodyAt(begin)), worker);
  prependTo(node.right(), end, static_cast<std::size_t>(bodyAt(end) - right), worker);
  node.left().check_all |= all;
  node.right().check_all |= all;
}

void Tree::trim(Node& node, const NodeContext& context, Worker& worker) {
  ++worker.counts[trims];
  nodes_.releaseChildren(node);
  node.own = node.size;
  node.own_dirty = node.dirty = true;
  setNodeOfOwn(node, context);
}

/// Moves the plane to the mean centre if that yields a good split.
bool Tree::translate(Node& node, const NodeContext& context, Worker& worker) {
  const std::span<const std::uint32_t> bodies(bodyAt(context.begin), node.size);
  double sum = 0;
  for (const std::uint32_t body : bodies) sum += centreOf(boxes_[body], node.axis);
  const auto mean = static_cast<float>(sum / node.size);
  if (mean == node.plane || !isGoodSplit(countSides(bodies, node.axis, mean))) return false;

  ++worker.counts[translations];
  const float before = std::exchange(node.plane, mean);
  node.own_dirty = node.check_all = true;
  // The cell of one child has shrunk: all of its bodies are tested against it.
  if (mean < before) {
    refit(node.left(), leftContext(node, context), Scope::all, worker);
  } else {
    refit(node.right(), rightContext(node, context), Scope::all, worker);
  }
  adopt(node, context, worker);
  return true;
}

/// The larger child takes over all bodies, then replaces the node.
void Tree::erase(Node& node, const NodeContext& context, Worker& worker) {
  ++worker.counts[erasures];
  Node* const pair = node.children;
  Node& left = node.left();
  Node& right = node.right();
  const bool keep_left = left.size >= right.size;
  const std::size_t end = context.begin + node.size;
  if (keep_left) {
    nodes_.releaseChildren(right);
    appendTo(left, context.begin, node.own + right.size, worker);
  } else {
    nodes_.releaseChildren(left);
    prependTo(right, end - right.size, left.size + node.own, worker);
  }
  const Node& kept = keep_left ? left : right;
  node.setChildren(kept.children);
  node.plane = kept.plane;
  node.axis = kept.axis;
  node.own = kept.own;
  node.own_dirty = node.check_all = true;
  nodes_.release(pair);
  setNodeOfOwn(node, context);
}

/// Gives a leaf with too many bodies a plane and two empty children. False if it is not split.
bool Tree::partition(Node& node, const NodeContext& context, Worker& worker) {
  if (node.own <= objects_per_leaf_) return false;
  if (!findSplit(node, {bodyAt(context.begin), node.own}, worker)) return false;
  ++worker.counts[partitions];
  node.setChildren(nodes_.take());
  node.own_dirty = node.check_all = true;
  return true;
}

/// Tries the mean on all axes, in descending order of variance, then the median on each: outliers
/// may pull the mean away from all other bodies.
bool Tree::findSplit(Node& node, std::span<const std::uint32_t> bodies, Worker& worker) const {
  const std::array<double, 3> origin = Moments::centre(boxes_[bodies[0]]);
  Moments moments;
  for (const std::uint32_t body : bodies) moments.add(boxes_[body], origin);
  const auto count = static_cast<double>(bodies.size());
  const auto mean = [&](int axis) {
    return static_cast<float>(origin[axis] + moments.sum[axis] / count);
  };
  const auto median = [&](int axis) {
    std::vector<float>& centres = worker.centres;
    centres.clear();
    for (const std::uint32_t body : bodies) {
      centres.push_back(static_cast<float>(centreOf(boxes_[body], axis)));
    }
    const auto middle = centres.begin() + static_cast<std::ptrdiff_t>(centres.size() / 2);
    std::ranges::nth_element(centres, middle);
    return *middle;
  };
  const auto try_planes = [&](auto plane_on) {
    for (const int axis : moments.axes(count)) {
      node.axis = axis;
      node.plane = plane_on(axis);
      if (isGoodSplit(countSides(bodies, node.axis, node.plane))) return true;
    }
    return false;
  };
  return try_planes(mean) || try_planes(median);
}

/// The `count` bodies after the slice of a left child, which begins at `begin`, become its own.
void Tree::appendTo(Node& child, std::size_t begin, std::size_t count, Worker& worker) {
  const std::size_t end = begin + child.size;
  const std::size_t own_end = child.isLeaf() ? end : end - child.right().size;
  swapBlocks(own_end, end, end + count, worker);
  addToOwn(child, own_end, count, worker);
  child.size += static_cast<std::uint32_t>(count);
}

/// The `count` bodies before the slice of a right child, which begins at `begin`, become its own.
void Tree::prependTo(Node& child, std::size_t begin, std::size_t count, Worker& worker) {
  const std::size_t left_size = child.isLeaf() ? 0 : child.left().size;
  swapBlocks(begin - count, begin, begin + left_size, worker);
  addToOwn(child, begin - count + left_size, count, worker);
  child.size += static_cast<std::uint32_t>(count);
}

/// The bodies must be adjacent to the node's own.
void Tree::addToOwn(Node& node, std::size_t begin, std::size_t count, Worker& worker) {
  if (count == 0) return;
  for (std::size_t i = begin; i < begin + count; ++i) node_of_[bodies_[i]] = &node;
  node.own += static_cast<std::uint32_t>(count);
  node.own_dirty = node.dirty = true;
  worker.counts[moves] += count;
}

void Tree::setNodeOfOwn(Node& node, const NodeContext& context) {
  const std::size_t begin = context.begin + (node.isLeaf() ? 0 : node.left().size);
  for (std::size_t i = begin; i < begin + node.own; ++i) node_of_[bodies_[i]] = &node;
}

/// std::rotate by block copies, with the smaller block in a buffer.
void Tree::swapBlocks(std::size_t begin, std::size_t middle, std::size_t end, Worker& worker) {
  std::vector<std::uint32_t>& swap_buffer = worker.swap_buffer;
  if (middle - begin <= end - middle) {
    swap_buffer.assign(bodyAt(begin), bodyAt(middle));
    std::copy(bodyAt(middle), bodyAt(end), bodyAt(begin));
    std::ranges::copy(swap_buffer, bodyAt(end) - swap_buffer.size());
  } else {
    swap_buffer.assign(bodyAt(middle), bodyAt(end));
    std::copy_backward(bodyAt(begin), bodyAt(middle), bodyAt(end));
    std::ranges::copy(swap_buffer, bodyAt(begin));
  }
}

}  // namespace broadmark::kd
