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
  // Bodies, and therefore planes, may lie outside of the world.
  const float plane = std::clamp(node.plane, region.min[node.axis], region.max[node.axis]);
  left.max[node.axis] = right.min[node.axis] = plane;
  Aabb plane_box = left;
  plane_box.min[node.axis] = plane;
  draw.box(plane_box, StructureRole::split, level);
  drawNode(draw, node.left(), left, level + 1);
  drawNode(draw, node.right(), right, level + 1);
}

std::string Tree::validate() const {
  if (root_.size != bodies_.size()) return "the size of the root is not the number of bodies";
  std::vector<char> seen(boxes_.size(), 0);
  for (const std::uint32_t body : bodies_) {
    if (body >= seen.size() || seen[body] != 0)
      return fmt::format("body {} is invalid or listed twice", body);
    seen[body] = 1;
  }
  for (std::uint32_t body = 0; body < seen.size(); ++body) {
    if (contains(body) != (seen[body] != 0) || (contains(body) && boxes_[body] == kAbsent)) {
      return fmt::format("body {} was inserted or removed without an update", body);
    }
  }
  return validateNode(root_, {});
}

std::string Tree::validateNode(const Node& node, const NodeContext& context) const {
  const std::size_t left_size = node.isLeaf() ? 0 : node.left().size;
  const std::size_t right_size = node.isLeaf() ? 0 : node.right().size;
  if (left_size + node.own + right_size != node.size) return "the sizes of a node do not add up";
  if (node.evicted != 0 || node.refitted) return "a refit is incomplete";
  if (!node.isLeaf() && (left_size == 0 || right_size == 0)) return "a child is empty";
  if (!node.isLeaf() && node.size < objects_per_leaf_) return "a node should have been trimmed";
  for (const std::uint32_t body : bodies().subspan(context.begin + left_size, node.own)) {
    const Aabb& box = boxes_[body];
    if (node_of_[body] != &node) return fmt::format("body {} is recorded in another node", body);
    if (!context.cell.contains(box)) return fmt::format("body {} is outside of its cell", body);
    if (!node.isLeaf() &&
        (isLeft(box, node.axis, node.plane) || isRight(box, node.axis, node.plane))) {
      return fmt::format("body {} does not straddle its node's plane", body);
    }
  }
  if (node.parent != nullptr && node.dirty && !node.parent->dirty) {
    return "a node is dirty, but not its parent";
  }
  if (!node.dirty && (node.own_dirty || node.work != 0))
    return "a node has dirty bodies, but is not dirty";
  if (node.isLeaf()) return {};
  if (node.left().parent != &node || node.right().parent != &node) return "a parent is wrong";
  std::string fault = validateNode(node.left(), leftContext(node, context));
  if (fault.empty()) fault = validateNode(node.right(), rightContext(node, context));
  return fault;
}

}  // namespace broadmark::kd
