// The nodes of the adaptive KD tree, and their pool.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <mutex>
#include <vector>

namespace broadmark::kd {

/// A node owns a contiguous slice of the tree's array of bodies: left child's | own | right
/// child's. Nodes store sizes only; the traversal computes where slices begin. So the slice of a
/// subtree can be shifted by one block move, without an update of its nodes.
struct Node {
  Node* parent = nullptr;    ///< null: the root
  Node* children = nullptr;  ///< left and right; null: a leaf
  float plane = 0;
  int axis = 0;
  std::uint32_t own = 0;   ///< in a leaf all bodies, else those that straddle the plane
  std::uint32_t size = 0;  ///< bodies of the subtree
  /// During a refit: evicted bodies, which lie between the slice and the parent's own bodies.
  std::uint32_t evicted = 0;
  std::uint32_t work = 0;  ///< own bodies of the dirty nodes of the subtree
  bool own_dirty = true;   ///< own bodies moved, were inserted or were removed
  bool dirty = true;       ///< own_dirty here or below
  bool check_all = false;  ///< test own bodies that did not move against the plane, too
  bool refitted = false;   ///< by a task, before its parent

  [[nodiscard]] bool isLeaf() const { return children == nullptr; }
  [[nodiscard]] Node& left() const { return children[0]; }
  [[nodiscard]] Node& right() const { return children[1]; }
  void setChildren(Node* pair) {
    children = pair;
    if (!isLeaf()) left().parent = right().parent = this;
  }
};

/// Thread-safe, with stable addresses. Nodes are allocated as pairs of siblings.
class NodePool {
 public:
  Node* take();
  void release(Node* pair);
  /// Makes the node a leaf.
  void releaseChildren(Node& node);
  /// Grows the pool in advance, so that workers do not allocate during an update.
  void reserve();

 private:
  void grow();

  std::deque<std::array<Node, 2>> pairs_;
  std::vector<Node*> free_;
  std::mutex mutex_;
};

}  // namespace broadmark::kd
