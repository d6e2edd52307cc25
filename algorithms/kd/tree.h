// The adaptive KD tree: a binary space partition that is updated incrementally.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "broadmark/aabb.h"
#include "broadmark/broad_phase.h"
#include "broadmark/debug_draw.h"
#include "broadmark/execution.h"
#include "kd/node.h"

namespace broadmark::kd {

/// The region of a node: lo <= x < hi on every axis. Half open, so that boxes in different cells
/// never touch.
struct Cell {
  static constexpr float kFar = std::numeric_limits<float>::infinity();
  std::array<float, 3> lo = {-kFar, -kFar, -kFar};
  std::array<float, 3> hi = {kFar, kFar, kFar};

  [[nodiscard]] bool contains(const Aabb& box) const {
    int inside = 1;  // branchless, since the result is unpredictable
    for (int axis = 0; axis < 3; ++axis) {
      inside &= static_cast<int>(lo[axis] <= box.min[axis]);
      inside &= static_cast<int>(box.max[axis] < hi[axis]);
    }
    return inside != 0;
  }
};

/// A box that touches the plane from the right is on the right.
inline bool isLeft(const Aabb& box, int axis, float plane) { return box.max[axis] < plane; }
inline bool isRight(const Aabb& box, int axis, float plane) { return box.min[axis] >= plane; }

/// Operations of an update.
enum Count { moves, trims, translations, erasures, partitions, skipped_subtrees };
inline constexpr std::array<std::string_view, 6> kCountNames = {
    "moves between nodes",        "trims", "translations", "erasures", "partitions",
    "subtrees skipped in updates"};

class Tree {
 public:
  /// Builds a tree of these bodies. `boxes` and `moved` have an element for every body that is ever
  /// inserted; they and `team` must outlive the tree. `moved` is 1 for the bodies that an update
  /// marks dirty or inserts. Leaves with more than `objects_per_leaf` bodies are split.
  void build(std::span<const Aabb> boxes, std::span<const std::uint8_t> moved,
             std::span<const std::uint32_t> bodies, std::size_t objects_per_leaf, ThreadTeam& team);

  static constexpr Aabb kAbsent = {{Cell::kFar, Cell::kFar, Cell::kFar, 0},
                                   {Cell::kFar, Cell::kFar, Cell::kFar, 0}};

  /// An update: beginUpdate(), markDirty() for the bodies with a new box, insert(), update(). The
  /// latter removes bodies with the box kAbsent. `all` marks all bodies dirty.
  void beginUpdate(bool all);
  /// Thread-safe.
  void markDirty(std::uint32_t body);
  void insert(std::span<const std::uint32_t> bodies);
  [[nodiscard]] bool contains(std::uint32_t body) const { return node_of_[body] != nullptr; }
  [[nodiscard]] std::size_t size() const { return bodies_.size(); }
  void update();

  [[nodiscard]] const Node& root() const { return root_; }
  /// All bodies in the tree: the array that nodes own slices of.
  [[nodiscard]] std::span<const std::uint32_t> bodies() const { return bodies_; }
  void visitCounters(const CounterVisitor& visit) const;

  void draw(DebugDraw& draw, const Aabb& world) const;
  /// "" or the broken invariant.
  [[nodiscard]] std::string validate() const;

 private:
  enum class Side { left, right, root };
  /// The state of a traversal at a node, in addition to the node.
  struct NodeContext {
    std::size_t begin = 0;  ///< of the node's slice
    Side side = Side::root;
    Cell cell;
  };
  struct Task {
    Node* node = nullptr;
    NodeContext context;
    std::size_t worker = 0;
  };
  struct SideCounts {
    std::size_t own = 0;
    std::size_t left = 0;
    std::size_t right = 0;
  };
  struct alignas(64) Worker {
    std::array<std::uint64_t, kCountNames.size()> counts{};
    std::vector<std::uint32_t> swap_buffer;  ///< the smaller one of two blocks
    std::vector<float> centres;              ///< scratch memory for medians
  };
  /// Which own bodies refit tests against the cell: all if the cell has shrunk.
  enum class Scope { dirty, all };

  static NodeContext leftContext(const Node& node, const NodeContext& context);
  static NodeContext rightContext(const Node& node, const NodeContext& context);
  static bool isGoodSplit(const SideCounts& sides);

  [[nodiscard]] std::uint32_t* bodyAt(std::size_t position) { return bodies_.data() + position; }
  [[nodiscard]] SideCounts countSides(std::span<const std::uint32_t> bodies, int axis,
                                      float plane) const;

  // Bottom-up: refit.
  void refitAll();
  void collectTasks(Node& node, const NodeContext& context);
  void refit(Node& node, const NodeContext& context, Scope scope, Worker& worker);
  void adopt(Node& node, const NodeContext& context, Worker& worker);
  void evict(Node& node, const NodeContext& context, Scope scope, Worker& worker);

  void removeAbsent();

  // Top-down: restructure.
  void restructureAll();
  void restructure(Node& node, const NodeContext& context, Worker& worker, bool defer_small);
  void waterfall(Node& node, const NodeContext& context, Worker& worker);
  void trim(Node& node, const NodeContext& context, Worker& worker);
  bool translate(Node& node, const NodeContext& context, Worker& worker);
  void erase(Node& node, const NodeContext& context, Worker& worker);
  bool partition(Node& node, const NodeContext& context, Worker& worker);
  bool findSplit(Node& node, std::span<const std::uint32_t> bodies, Worker& worker) const;

  void appendTo(Node& child, std::size_t begin, std::size_t count, Worker& worker);
  void prependTo(Node& child, std::size_t begin, std::size_t count, Worker& worker);
  void addToOwn(Node& node, std::size_t begin, std::size_t count, Worker& worker);
  void setNodeOfOwn(Node& node, const NodeContext& context);
  void swapBlocks(std::size_t begin, std::size_t middle, std::size_t end, Worker& worker);

  template <class Work>
  void runTasks(Work work);

  void drawNode(DebugDraw& draw, const Node& node, const Aabb& region, int level) const;
  [[nodiscard]] std::string validateNode(const Node& node, const NodeContext& context) const;

  std::span<const Aabb> boxes_;
  std::span<const std::uint8_t> moved_;
  std::size_t objects_per_leaf_ = 0;
  ThreadTeam* team_ = nullptr;
  Node root_;
  std::vector<std::uint32_t> bodies_;
  std::vector<Node*> node_of_;  ///< by body; null: not in the tree
  std::vector<Worker> workers_;
  std::vector<Task> tasks_;    ///< disjoint subtrees, in the order of their slices
  std::size_t task_size_ = 0;  ///< maximum number of bodies in a task

  NodePool nodes_;  ///< all nodes except the root
};

}  // namespace broadmark::kd
