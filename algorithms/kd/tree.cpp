// An update has two passes over the touched part of the tree.
//
// Bottom-up, refit: bodies that no longer fit in their node's cell go to the parent's own, step by
// step. Within the parent's slice they only have to change sides with the subtree between.
//
// Top-down, settle: own bodies that no longer straddle the plane go to the child on their side
// (waterfall); a node that holds too little, or has an empty child, becomes a leaf (trim); one that
// divides its bodies badly gets its plane moved to their mean centre (translate) or, if that does
// not help, is replaced by its larger child (erase); a leaf that holds too much is split
// (partition).
//
// Both look only at bodies that moved, came or go: the others are where they belong, but for nodes
// that have got another plane or cell.
//
// For several workers the tree is cut into subtrees whose slices, being disjoint, can be worked on
// at the same time; what lies above them is done by one, after the first pass and before the
// second.

#include "kd/tree.h"

#include <algorithm>
#include <atomic>
#include <functional>
#include <utility>

#include "moments.h"

namespace broadmark::kd {
namespace {

/// Subtrees that the tree is cut into, for each worker.
constexpr std::size_t kTasksPerWorker = 8;

/// Sums up the work in the touched part of the subtree.
void summarise(Node& node) {
  if (!node.touched) return;
  node.touched = node.own_touched;
  node.work = node.own_touched ? node.own : 0;
  if (node.isLeaf()) return;
  for (Node* child : {&node.left(), &node.right()}) {
    summarise(*child);
    node.touched |= child->touched;
    node.work += child->work;
  }
}

void touchAll(Node& node) {
  node.own_touched = node.touched = true;
  if (node.isLeaf()) return;
  touchAll(node.left());
  touchAll(node.right());
}

/// Makes the touched part of the subtree as if it had never been touched.
void forgetTouched(Node& node) {
  if (!node.touched) return;
  node.own_touched = node.touched = false;
  node.work = 0;
  if (node.isLeaf()) return;
  forgetTouched(node.left());
  forgetTouched(node.right());
}

}  // namespace

void Tree::build(std::span<const Aabb> boxes, std::span<const std::uint8_t> moving,
                 std::span<const std::uint32_t> bodies, std::size_t objects_per_leaf,
                 ThreadTeam& team) {
  boxes_ = boxes;
  moving_ = moving;
  objects_per_leaf_ = objects_per_leaf;
  team_ = &team;
  workers_.resize(static_cast<std::size_t>(team.size()));
  if (!root_.isLeaf()) nodes_.releaseChildren(root_);
  root_ = {};
  bodies_.clear();
  bodies_.reserve(boxes.size());
  homes_.assign(boxes.size(), nullptr);
  beginUpdate(true);
  admit(bodies);
  update();
}

void Tree::beginUpdate(bool all) {
  for (Worker& worker : workers_) worker.counts = {};
  all ? touchAll(root_) : forgetTouched(root_);
}

void Tree::touch(std::uint32_t body) {
  // Mostly it has been set already; then the line stays shared between the workers.
  const auto set = [](bool& mark) {
    const std::atomic_ref<bool> shared(mark);
    const bool before = shared.load(std::memory_order_relaxed);
    if (!before) shared.store(true, std::memory_order_relaxed);
    return !before;
  };
  Node* node = homes_[body];
  set(node->own_touched);
  while (node != nullptr && set(node->touched)) node = node->parent;
}

void Tree::admit(std::span<const std::uint32_t> bodies) {
  if (bodies.empty()) return;
  bodies_.insert(bodies_.end(), bodies.begin(), bodies.end());
  giveToLeft(root_, 0, bodies.size(), workers_[0]);
}

void Tree::update() {
  nodes_.reserve();
  const std::size_t parts = team_->size() == 1 ? 1 : workers_.size() * kTasksPerWorker;
  grain_ = bodies_.size() / parts;
  refitAll();
  expelGone();
  settleAll();
  summarise(root_);
}

Tree::Place Tree::leftPlace(const Node& node, const Place& place) {
  Place left = {place.begin, Side::left, place.cell};
  // Not simply the plane: it may have been moved beyond what an ancestor leaves of the cell.
  left.cell.hi[node.axis] = std::min(left.cell.hi[node.axis], node.plane);
  return left;
}

Tree::Place Tree::rightPlace(const Node& node, const Place& place) {
  const std::size_t begin = place.begin + node.left().size + node.left().escaped + node.own;
  Place right = {begin, Side::right, place.cell};
  right.cell.lo[node.axis] = std::max(right.cell.lo[node.axis], node.plane);
  return right;
}

/// Whether cost <= balance. The cost is the pairs that remain to be tested, 0 for those of two
/// equal halves and 1 for all; the balance is 1 for equal children and no straddlers, 0 for an
/// empty child.
bool Tree::isGood(const Populations& p) {
  const auto own = static_cast<double>(p.own);
  const auto left = static_cast<double>(p.left);
  const auto right = static_cast<double>(p.right);
  const double all = own + left + right;
  const double pairs = (own * own + left * left + right * right - all) / 2 + own * (left + right);
  const double fewest = (all / 2) * (all / 2) - all / 2;
  const double most = (all * all - all) / 2;
  const double balance = std::min(left, right) / (std::max(left, right) + own);
  return pairs - fewest <= balance * (most - fewest);
}

Tree::Populations Tree::populationsAt(std::span<const std::uint32_t> bodies, int axis,
                                      float plane) const {
  Populations p;
  for (const std::uint32_t body : bodies) {
    p.left += isLeft(boxes_[body], axis, plane);
    p.right += isRight(boxes_[body], axis, plane);
  }
  p.own = bodies.size() - p.left - p.right;
  return p;
}

/// Every worker gets a run of tasks, about the same number of bodies in each.
template <class Work>
void Tree::runTasks(Work work) {
  std::size_t total = 0;
  for (const Task& task : tasks_) total += task.node->touched ? task.node->size : 0;
  total = std::max<std::size_t>(total, 1);
  // Weighed now: the work changes the sizes.
  for (std::size_t before = 0; Task & task : tasks_) {
    task.worker = std::min(before * workers_.size() / total, workers_.size() - 1);
    before += task.node->touched ? task.node->size : 0;
  }
  team_->run([&](int worker) {
    for (const Task& task : tasks_) {
      if (task.worker == static_cast<std::size_t>(worker)) work(task, workers_[task.worker]);
    }
  });
}

void Tree::refitAll() {
  tasks_.clear();
  findTasks(root_, {});
  runTasks([this](const Task& task, Worker& worker) {
    refit(*task.node, task.place, Scope::touched, worker);
    task.node->refitted = true;
  });
  if (!root_.refitted) refit(root_, {}, Scope::touched, workers_[0]);
  for (const Task& task : tasks_) task.node->refitted = false;
}

void Tree::findTasks(Node& node, const Place& place) {
  if (node.isLeaf() || node.size <= grain_) {
    tasks_.push_back({&node, place});
    return;
  }
  findTasks(node.left(), leftPlace(node, place));
  findTasks(node.right(), rightPlace(node, place));
}

void Tree::refit(Node& node, const Place& place, Scope scope, Worker& worker) {
  if (!node.touched && scope == Scope::touched) {
    ++worker.counts[skipped_subtrees];
    return;
  }
  if (!node.isLeaf()) {
    const Place left = leftPlace(node, place);
    const Place right = rightPlace(node, place);
    if (!node.left().refitted) refit(node.left(), left, scope, worker);
    if (!node.right().refitted) refit(node.right(), right, scope, worker);
    adoptEscaped(node, place, worker);
  }
  if (place.side != Side::root && (node.own_touched || scope == Scope::all)) {
    letEscape(node, place, scope, worker);
  }
}

/// The slice is: left's | escaped from left | own | escaped from right | right's. All between left
/// and right becomes own.
void Tree::adoptEscaped(Node& node, const Place& place, Worker& worker) {
  const std::uint32_t from_left = std::exchange(node.left().escaped, 0);
  const std::uint32_t from_right = std::exchange(node.right().escaped, 0);
  const std::size_t begin = place.begin + node.left().size;
  receive(node, begin, from_left, worker);
  receive(node, begin + node.own, from_right, worker);
}

void Tree::letEscape(Node& node, const Place& place, Scope scope, Worker& worker) {
  const auto holds = [&](std::uint32_t body) {
    return (scope == Scope::touched && moving_[body] == 0) || place.cell.holds(boxes_[body]);
  };
  const std::size_t left_size = node.isLeaf() ? 0 : node.left().size;
  const std::size_t begin = place.begin + left_size;
  const std::size_t end = begin + node.own;
  std::size_t escaped = 0;
  if (place.side == Side::left) {
    const auto middle = std::partition(at(begin), at(end), holds);
    escaped = static_cast<std::size_t>(at(end) - middle);
    rotate(end - escaped, end, place.begin + node.size, worker);
  } else {
    const auto middle = std::partition(at(begin), at(end), std::not_fn(holds));
    escaped = static_cast<std::size_t>(middle - at(begin));
    rotate(place.begin, begin, begin + escaped, worker);
  }
  if (escaped == 0) return;
  node.escaped = static_cast<std::uint32_t>(escaped);
  node.own -= node.escaped;
  node.size -= node.escaped;
  node.own_touched = node.touched = true;
}

/// No cell holds a box of kGone, so by now all of these are the root's own.
void Tree::expelGone() {
  if (!root_.own_touched) return;
  const std::size_t begin = root_.isLeaf() ? 0 : root_.left().size;
  const std::size_t end = begin + root_.own;
  std::uint32_t* const gone = std::partition(at(begin), at(end), [this](std::uint32_t body) {
    return moving_[body] == 0 || boxes_[body] != kGone;
  });
  const auto count = static_cast<std::uint32_t>(at(end) - gone);
  if (count == 0) return;
  for (const std::uint32_t* body = gone; body != at(end); ++body) homes_[*body] = nullptr;
  rotate(end - count, end, bodies_.size(), workers_[0]);
  bodies_.resize(bodies_.size() - count);
  root_.own -= count;
  root_.size -= count;
}

void Tree::settleAll() {
  tasks_.clear();
  settle(root_, {}, workers_[0], true);
  runTasks(
      [this](const Task& task, Worker& worker) { settle(*task.node, task.place, worker, false); });
}

/// `defer_small`: subtrees that are not worth dividing further become tasks instead.
void Tree::settle(Node& node, const Place& place, Worker& worker, bool defer_small) {
  if (!node.touched) {
    ++worker.counts[skipped_subtrees];
    return;
  }
  if (defer_small && node.size <= grain_) {
    tasks_.push_back({&node, place});
    return;
  }
  // Ends: a partition is good at once, an erasure leaves fewer nodes, and a translation comes
  // before another erasure only where it makes the node good.
  while (!node.isLeaf() || partition(node, place, worker)) {
    waterfall(node, place, worker);
    const Populations p = {node.own, node.left().size, node.right().size};
    if (node.size < objects_per_leaf_ || p.left == 0 || p.right == 0) {
      trim(node, place, worker);
    } else if (isGood(p)) {
      settle(node.left(), leftPlace(node, place), worker, defer_small);
      settle(node.right(), rightPlace(node, place), worker, defer_small);
      return;
    } else if (!translate(node, place, worker)) {
      erase(node, place, worker);
    }
  }
}

void Tree::waterfall(Node& node, const Place& place, Worker& worker) {
  if (!node.own_touched) return;
  const bool all = std::exchange(node.unsettled, false);
  const auto may_go = [&](std::uint32_t body) { return all || moving_[body] != 0; };
  const auto is_left = [&](std::uint32_t body) {
    return may_go(body) && isLeft(boxes_[body], node.axis, node.plane);
  };
  const auto is_not_right = [&](std::uint32_t body) {
    return !may_go(body) || !isRight(boxes_[body], node.axis, node.plane);
  };
  const std::size_t begin = place.begin + node.left().size;
  const std::size_t end = begin + node.own;
  std::uint32_t* const stay = std::partition(at(begin), at(end), is_left);
  std::uint32_t* const go_right = std::partition(stay, at(end), is_not_right);
  node.own = static_cast<std::uint32_t>(go_right - stay);
  giveToLeft(node.left(), place.begin, static_cast<std::size_t>(stay - at(begin)), worker);
  giveToRight(node.right(), end, static_cast<std::size_t>(at(end) - go_right), worker);
  node.left().unsettled |= all;
  node.right().unsettled |= all;
}

void Tree::trim(Node& node, const Place& place, Worker& worker) {
  ++worker.counts[trims];
  nodes_.releaseChildren(node);
  node.own = node.size;
  node.own_touched = node.touched = true;
  makeHome(node, place);
}

/// Moves the plane to the mean centre if that makes the node good.
bool Tree::translate(Node& node, const Place& place, Worker& worker) {
  const std::span<const std::uint32_t> bodies(at(place.begin), node.size);
  double sum = 0;
  for (const std::uint32_t body : bodies) sum += centreOf(boxes_[body], node.axis);
  const auto mean = static_cast<float>(sum / node.size);
  if (mean == node.plane || !isGood(populationsAt(bodies, node.axis, mean))) return false;

  ++worker.counts[translations];
  const float before = std::exchange(node.plane, mean);
  node.own_touched = node.unsettled = true;
  // One child's cell has become smaller, and all its bodies have to be looked at.
  if (mean < before) {
    refit(node.left(), leftPlace(node, place), Scope::all, worker);
  } else {
    refit(node.right(), rightPlace(node, place), Scope::all, worker);
  }
  adoptEscaped(node, place, worker);
  return true;
}

/// The larger child takes over all bodies, then the node's place.
void Tree::erase(Node& node, const Place& place, Worker& worker) {
  ++worker.counts[erasures];
  Node* const pair = node.children;
  Node& left = node.left();
  Node& right = node.right();
  const bool keep_left = left.size >= right.size;
  const std::size_t end = place.begin + node.size;
  if (keep_left) {
    nodes_.releaseChildren(right);
    giveToLeft(left, place.begin, node.own + right.size, worker);
  } else {
    nodes_.releaseChildren(left);
    giveToRight(right, end - right.size, left.size + node.own, worker);
  }
  const Node& kept = keep_left ? left : right;
  node.setChildren(kept.children);
  node.plane = kept.plane;
  node.axis = kept.axis;
  node.own = kept.own;
  node.own_touched = node.unsettled = true;
  nodes_.release(pair);
  makeHome(node, place);
}

/// Gives a leaf that holds too much a plane and two empty children. False if it is not to be split.
bool Tree::partition(Node& node, const Place& place, Worker& worker) {
  if (node.own <= objects_per_leaf_) return false;
  if (!findSplit(node, {at(place.begin), node.own}, worker)) return false;
  ++worker.counts[partitions];
  node.setChildren(nodes_.take());
  node.own_touched = node.unsettled = true;
  return true;
}

/// The axis of largest variance at the mean; where that is no good, the other axes; where none is,
/// as a few bodies far away draw the mean aside, the same at the median.
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
  const auto try_planes = [&](auto planeOn) {
    for (const int axis : moments.axes(count)) {
      node.axis = axis;
      node.plane = planeOn(axis);
      if (isGood(populationsAt(bodies, node.axis, node.plane))) return true;
    }
    return false;
  };
  return try_planes(mean) || try_planes(median);
}

/// `count` bodies just behind the slice of a left child, which begins at `begin`, become its own.
void Tree::giveToLeft(Node& child, std::size_t begin, std::size_t count, Worker& worker) {
  const std::size_t end = begin + child.size;
  const std::size_t own_end = child.isLeaf() ? end : end - child.right().size;
  rotate(own_end, end, end + count, worker);
  receive(child, own_end, count, worker);
  child.size += static_cast<std::uint32_t>(count);
}

/// `count` bodies just before the slice of a right child, which begins at `begin`, become its own.
void Tree::giveToRight(Node& child, std::size_t begin, std::size_t count, Worker& worker) {
  const std::size_t left_size = child.isLeaf() ? 0 : child.left().size;
  rotate(begin - count, begin, begin + left_size, worker);
  receive(child, begin - count + left_size, count, worker);
  child.size += static_cast<std::uint32_t>(count);
}

/// Makes bodies at the edge of the node's own its own.
void Tree::receive(Node& node, std::size_t begin, std::size_t count, Worker& worker) {
  if (count == 0) return;
  for (std::size_t i = begin; i < begin + count; ++i) homes_[bodies_[i]] = &node;
  node.own += static_cast<std::uint32_t>(count);
  node.own_touched = node.touched = true;
  worker.counts[moves] += count;
}

void Tree::makeHome(Node& node, const Place& place) {
  const std::size_t begin = place.begin + (node.isLeaf() ? 0 : node.left().size);
  for (std::size_t i = begin; i < begin + node.own; ++i) homes_[bodies_[i]] = &node;
}

/// Exchanges the neighbouring blocks [begin, middle) and [middle, end), each as a whole.
void Tree::rotate(std::size_t begin, std::size_t middle, std::size_t end, Worker& worker) {
  std::vector<std::uint32_t>& aside = worker.aside;
  if (middle - begin <= end - middle) {
    aside.assign(at(begin), at(middle));
    std::copy(at(middle), at(end), at(begin));
    std::ranges::copy(aside, at(end) - aside.size());
  } else {
    aside.assign(at(middle), at(end));
    std::copy_backward(at(begin), at(middle), at(end));
    std::ranges::copy(aside, at(begin));
  }
}

}  // namespace broadmark::kd
