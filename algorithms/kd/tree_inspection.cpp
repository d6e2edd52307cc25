// Looking at an adaptive KD tree: its counters, a drawing, and its invariants.

#include <fmt/format.h>

#include <algorithm>

#include "kd/tree.h"

namespace broadmark::kd {

void Tree::visitCounters(const CounterVisitor& visit) const {
  for (std::size_t i = 0; i < kCountNames.size(); ++i) {
    std::uint64_t sum = 0;
    for (const Worker& worker : workers_) sum += worker.counts[i];
    visit(kCountNames[i], sum);
  }
}

void Tree::draw(DebugDraw& draw, const Aabb& world) const { drawNode(draw, root_, world, 0); }

void Tree::drawNode(DebugDraw& draw, const Node& node, const Aabb& region, int level) const {
  if (node.own > 0) {
    draw.cell(region, level, node.own);
  } else {
    draw.box(region, StructureRole::cell, level);
  }
  if (node.isLeaf()) return;
  Aabb left = region;
  Aabb right = region;
  // Bodies, and so planes, may lie outside of the world.
  const float plane = std::clamp(node.plane, region.min[node.axis], region.max[node.axis]);
  left.max[node.axis] = right.min[node.axis] = plane;
  Aabb plane_box = left;
  plane_box.min[node.axis] = plane;
  draw.box(plane_box, StructureRole::split, level);
  drawNode(draw, node.left(), left, level + 1);
  drawNode(draw, node.right(), right, level + 1);
}

std::string Tree::validate() const {
  if (root_.size != bodies_.size()) return "the root does not hold all bodies";
  std::vector<char> seen(boxes_.size(), 0);
  for (const std::uint32_t body : bodies_) {
    if (body >= seen.size() || seen[body] != 0)
      return fmt::format("body {} is lost or twice", body);
    seen[body] = 1;
  }
  for (std::uint32_t body = 0; body < seen.size(); ++body) {
    if (holds(body) != (seen[body] != 0) || (holds(body) && boxes_[body] == kGone)) {
      return fmt::format("body {} came or went unseen", body);
    }
  }
  return validateNode(root_, {});
}

std::string Tree::validateNode(const Node& node, const Place& place) const {
  const std::size_t left_size = node.isLeaf() ? 0 : node.left().size;
  const std::size_t right_size = node.isLeaf() ? 0 : node.right().size;
  if (left_size + node.own + right_size != node.size) return "a node's populations do not add up";
  if (node.escaped != 0 || node.refitted) return "a refit was not completed";
  if (!node.isLeaf() && (left_size == 0 || right_size == 0)) return "a child is empty";
  if (!node.isLeaf() && node.size < objects_per_leaf_) return "a node should have been trimmed";
  for (const std::uint32_t body : bodies().subspan(place.begin + left_size, node.own)) {
    const Aabb& box = boxes_[body];
    if (homes_[body] != &node) return fmt::format("body {} is taken to be elsewhere", body);
    if (!place.cell.holds(box)) return fmt::format("body {} is outside of its cell", body);
    if (!node.isLeaf() &&
        (isLeft(box, node.axis, node.plane) || isRight(box, node.axis, node.plane))) {
      return fmt::format("body {} does not straddle its node's plane", body);
    }
  }
  if (node.parent != nullptr && node.touched && !node.parent->touched) {
    return "a node is touched and its parent is not";
  }
  if (!node.touched && (node.own_touched || node.work != 0)) return "a touched node was forgotten";
  if (node.isLeaf()) return {};
  if (node.left().parent != &node || node.right().parent != &node) return "a parent is wrong";
  std::string fault = validateNode(node.left(), leftPlace(node, place));
  if (fault.empty()) fault = validateNode(node.right(), rightPlace(node, place));
  return fault;
}

}  // namespace broadmark::kd
