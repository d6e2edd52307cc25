// The nodes of the adaptive KD tree, and the stock that they are taken from.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <mutex>
#include <vector>

namespace broadmark::kd {

/// A node owns a contiguous slice of the tree's array of bodies: left child's | own | right
/// child's. Only populations are kept; where slices begin follows on the way down. So to shift the
/// slice of a whole subtree is one block move that touches no node.
struct Node {
  Node* parent = nullptr;    ///< null: the root
  Node* children = nullptr;  ///< left and right; null: a leaf
  float plane = 0;
  int axis = 0;
  std::uint32_t own = 0;   ///< bodies kept here: in a leaf all, else those that straddle the plane
  std::uint32_t size = 0;  ///< bodies of the subtree
  /// During a refit: bodies that no longer fit in the cell, just outside of the slice, on the side
  /// towards the parent's own.
  std::uint32_t escaped = 0;
  std::uint32_t work = 0;   ///< own bodies of the touched nodes of the subtree
  bool own_touched = true;  ///< in this frame own bodies moved, came or went
  bool touched = true;      ///< here or anywhere below; else nothing of this node has changed
  bool unsettled = false;   ///< own bodies that did not move may be on one side of the plane, too
  bool refitted = false;    ///< in parallel, before its parent

  [[nodiscard]] bool isLeaf() const { return children == nullptr; }
  [[nodiscard]] Node& left() const { return children[0]; }
  [[nodiscard]] Node& right() const { return children[1]; }
  void setChildren(Node* pair) {
    children = pair;
    if (!isLeaf()) left().parent = right().parent = this;
  }
};

/// Pairs of nodes, which stay where they are. Workers may take and release them at the same time.
class NodePool {
 public:
  /// Two fresh nodes.
  Node* take();
  void release(Node* pair);
  /// Makes the node a leaf.
  void releaseChildren(Node& node);
  /// Keeps a stock of nodes, so that workers need not allocate when they take and release nodes in
  /// another order than before.
  void reserve();

 private:
  void grow();

  std::deque<std::array<Node, 2>> pairs_;
  std::vector<Node*> free_;
  std::mutex mutex_;
};

}  // namespace broadmark::kd
