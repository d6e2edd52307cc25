// The adaptive KD tree itself: who is where, and how that is kept up to date.
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

/// The region of a node: lo <= x < hi on every axis. Half open, so that boxes in two different
/// cells never touch.
struct Cell {
  static constexpr float kFar = std::numeric_limits<float>::infinity();
  std::array<float, 3> lo = {-kFar, -kFar, -kFar};
  std::array<float, 3> hi = {kFar, kFar, kFar};

  [[nodiscard]] bool holds(const Aabb& box) const {
    int inside = 1;  // without branches: a few comparisons cost less than a wrong guess
    for (int axis = 0; axis < 3; ++axis) {
      inside &= static_cast<int>(lo[axis] <= box.min[axis]);
      inside &= static_cast<int>(box.max[axis] < hi[axis]);
    }
    return inside != 0;
  }
};

/// Which side of a plane a box is on. A box that touches the plane from the right is on the right.
inline bool isLeft(const Aabb& box, int axis, float plane) { return box.max[axis] < plane; }
inline bool isRight(const Aabb& box, int axis, float plane) { return box.min[axis] >= plane; }

/// What one frame's update did, as counters call it.
enum Count { moves, trims, translations, erasures, partitions, skipped_subtrees };
inline constexpr std::array<std::string_view, 6> kCountNames = {
    "moves between nodes",        "trims", "translations", "erasures", "partitions",
    "subtrees skipped in updates"};

class Tree {
 public:
  /// Puts these bodies into a new tree. `boxes` and `moving`, one for every body that may ever be
  /// in it, and `team` must outlive the tree; leaves are split when they hold more than
  /// `objects_per_leaf`. `moving` is 1 for the bodies touched or admitted in an update.
  void build(std::span<const Aabb> boxes, std::span<const std::uint8_t> moving,
             std::span<const std::uint32_t> bodies, std::size_t objects_per_leaf, ThreadTeam& team);

  /// The box of a body that is not there.
  static constexpr Aabb kGone = {{Cell::kFar, Cell::kFar, Cell::kFar, 0},
                                 {Cell::kFar, Cell::kFar, Cell::kFar, 0}};

  /// An update is: beginUpdate, touch for every body in the tree whose box has changed, admit for
  /// those that are new, update. Bodies in the tree whose box is kGone leave it.
  /// `all`: as if all bodies were touched.
  void beginUpdate(bool all);
  /// May be called by several workers at once.
  void touch(std::uint32_t body);
  void admit(std::span<const std::uint32_t> bodies);
  /// Whether the body is in the tree.
  [[nodiscard]] bool holds(std::uint32_t body) const { return homes_[body] != nullptr; }
  [[nodiscard]] std::size_t size() const { return bodies_.size(); }
  void update();

  [[nodiscard]] const Node& root() const { return root_; }
  /// The array of bodies that nodes own slices of: all in the tree.
  [[nodiscard]] std::span<const std::uint32_t> bodies() const { return bodies_; }
  /// Of the last update.
  void visitCounters(const CounterVisitor& visit) const;

  void draw(DebugDraw& draw, const Aabb& world) const;
  /// "" or which invariant is broken.
  [[nodiscard]] std::string validate() const;

 private:
  /// On which side of its parent's own bodies a node's slice lies.
  enum class Side { left, right, root };
  struct Place {
    std::size_t begin = 0;  ///< of the node's slice
    Side side = Side::root;
    Cell cell;
  };
  struct Task {
    Node* node = nullptr;
    Place place;
    std::size_t worker = 0;
  };
  struct Populations {
    std::size_t own = 0;
    std::size_t left = 0;
    std::size_t right = 0;
  };
  struct alignas(64) Worker {
    std::array<std::uint64_t, kCountNames.size()> counts{};
    std::vector<std::uint32_t> aside;  ///< the smaller block of a rotation
    std::vector<float> centres;        ///< room for finding their median
  };
  /// Whether refit looks at what moves only, or at all, because the cell has become smaller.
  enum class Scope { touched, all };

  static Place leftPlace(const Node& node, const Place& place);
  static Place rightPlace(const Node& node, const Place& place);
  static bool isGood(const Populations& p);

  [[nodiscard]] std::uint32_t* at(std::size_t position) { return bodies_.data() + position; }
  [[nodiscard]] Populations populationsAt(std::span<const std::uint32_t> bodies, int axis,
                                          float plane) const;

  // Bottom-up.
  void refitAll();
  void findTasks(Node& node, const Place& place);
  void refit(Node& node, const Place& place, Scope scope, Worker& worker);
  void adoptEscaped(Node& node, const Place& place, Worker& worker);
  void letEscape(Node& node, const Place& place, Scope scope, Worker& worker);

  void expelGone();

  // Top-down.
  void settleAll();
  void settle(Node& node, const Place& place, Worker& worker, bool defer_small);
  void waterfall(Node& node, const Place& place, Worker& worker);
  void trim(Node& node, const Place& place, Worker& worker);
  bool translate(Node& node, const Place& place, Worker& worker);
  void erase(Node& node, const Place& place, Worker& worker);
  bool partition(Node& node, const Place& place, Worker& worker);
  bool findSplit(Node& node, std::span<const std::uint32_t> bodies, Worker& worker) const;

  void giveToLeft(Node& child, std::size_t begin, std::size_t count, Worker& worker);
  void giveToRight(Node& child, std::size_t begin, std::size_t count, Worker& worker);
  void receive(Node& node, std::size_t begin, std::size_t count, Worker& worker);
  void makeHome(Node& node, const Place& place);
  void rotate(std::size_t begin, std::size_t middle, std::size_t end, Worker& worker);

  template <class Work>
  void runTasks(Work work);

  void drawNode(DebugDraw& draw, const Node& node, const Aabb& region, int level) const;
  [[nodiscard]] std::string validateNode(const Node& node, const Place& place) const;

  std::span<const Aabb> boxes_;
  std::span<const std::uint8_t> moving_;
  std::size_t objects_per_leaf_ = 0;
  ThreadTeam* team_ = nullptr;
  Node root_;
  std::vector<std::uint32_t> bodies_;  ///< that nodes own slices of
  std::vector<Node*> homes_;  ///< by body: the node that it is own of; null: not in the tree
  std::vector<Worker> workers_;
  std::vector<Task> tasks_;  ///< subtrees for one worker each, in the order of their slices
  std::size_t grain_ = 0;    ///< a subtree with no more bodies than this is one task

  NodePool nodes_;  ///< all but the root
};

}  // namespace broadmark::kd
