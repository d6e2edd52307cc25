// Box3D's dynamic tree (b3DynamicTree), in two ways. O(m log n + k) time for m bodies that leave
// their enlarged boxes, if few boxes of the tree overlap; O(n + k) space.
//
// box3d-tree follows Box3D's own broad phase, which is not public (broad_phase.c): a box is
// enlarged when its body has left it, by up to 0.05. A move buffer holds the enlarged and new
// bodies, which query the trees for pairs that are not known yet; of two such bodies, the one with
// the lower id finds the pair. The part of a tree that has grown is rebuilt: before the queries,
// which would traverse grown boxes otherwise; Box3D does so beside its narrow phase, after them.
// There is a tree for static geometry, that is, layers that never collide with each other, and
// layers are the tree's categories. Box3D ends a pair when the enlarged boxes separate; here these
// pairs are candidates (candidate_pairs.h), and the answer is exact.
//
// box3d-rebuild inserts the boxes themselves, rebuilds the whole tree each frame (as Box3D does for
// static geometry), and each body queries it.
//
// Box3D drops subtrees below 1,024 levels, from queries and rebuilds alike. Inserted one by one,
// equal boxes make a level each, so a tree that high is rebuilt.
//
// Library: Box3D 0.1, E. Catto.

#include <box3d/box3d.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "broadmark/non_colliding_layers.h"
#include "broadmark/plugin.h"
#include "candidate_pairs.h"

namespace broadmark::box3d_dynamic_tree {
namespace {

constexpr int kNoProxy = -1;
/// A rebuild in the same frame may double it.
constexpr int kMaxHeight = 500;
/// Box3D computes the bytes of its nodes as an int; their number grows by half.
constexpr std::uint64_t kMaxBodies = std::numeric_limits<int>::max() / sizeof(b3TreeNode) / 3;

b3AABB boundsOf(const Aabb& box) {
  return {{box.min[0], box.min[1], box.min[2]}, {box.max[0], box.max[1], box.max[2]}};
}

class Tree {
 public:
  Tree() = default;
  Tree(const Tree&) = delete;
  Tree& operator=(const Tree&) = delete;
  ~Tree() { b3DynamicTree_Destroy(&tree_); }

  int add(const Aabb& box, std::uint64_t category, std::uint32_t body) {
    const int proxy = b3DynamicTree_CreateProxy(&tree_, boundsOf(box), category, body);
    if (isTooHigh()) b3DynamicTree_Rebuild(&tree_, true);
    return proxy;
  }
  void remove(int proxy) { b3DynamicTree_DestroyProxy(&tree_, proxy); }
  /// The box may be anywhere. Queries are slow until the next rebuild().
  void setBox(int proxy, const Aabb& box) {
    b3DynamicTree_EnlargeProxy(&tree_, proxy, boundsOf(box));
  }
  /// Rebuilds all of the tree, or the part that has grown.
  void rebuild(bool all) { b3DynamicTree_Rebuild(&tree_, all || isTooHigh()); }

  /// Calls visit(body) for each box that overlaps this one, and has one of the categories.
  template <class Visit>
  void query(const Aabb& box, std::uint64_t categories, Visit visit) const {
    b3DynamicTree_Query(
        &tree_, boundsOf(box), categories, false,
        [](int, std::uint64_t body, void* context) {
          (*static_cast<Visit*>(context))(static_cast<std::uint32_t>(body));
          return true;
        },
        &visit);
  }

 private:
  [[nodiscard]] bool isTooHigh() const { return b3DynamicTree_GetHeight(&tree_) > kMaxHeight; }

  b3DynamicTree tree_ = b3DynamicTree_Create(0);
};

class EnlargedBoxes final : public BroadPhase {
 public:
  void visitParameters(const ParameterVisitor& visit) override {
    visit({"enlargement", "maximum margin added to a box that its body left, in world units",
           &max_enlargement_, 0, 1e6});
  }

  void initialize(const SceneInfo& scene, const Frame& first,
                  ExecutionContext& execution) override {
    filter_ = scene.filter;
    is_layered_ = filter_.worlds().empty() && filter_.tags().empty();
    team_ = &execution.team();
    boxes_.assign(first.boxes.size(), kEmptyBox);
    fat_boxes_ = boxes_;
    proxies_.assign(boxes_.size(), kNoProxy);
    for (auto* flags : {&is_static_, &has_moved_, &is_buffered_}) flags->assign(boxes_.size(), 0);
    const std::vector<std::uint32_t> present = first.presentBodies();
    static_layers_ = NonCollidingLayers(filter_, present);
    for (const std::uint32_t body : present) move(body, first.boxes[body]);
    for (Tree& tree : trees_) tree.rebuild(true);
    searchOverlaps();
  }

  void updateObjects(const Frame& frame) override {
    for (const std::uint32_t body : moved_) has_moved_[body] = 0;
    for (const std::uint32_t body : buffer_) is_buffered_[body] = 0;
    moved_.clear();
    buffer_.clear();
    // Enlarging is part of the objects' update in Box3D as well.
    for (const std::uint32_t body : *frame.changed) move(body, frame.boxes[body]);
  }

  void cleanCache() override { pairs_.clearEvents(); }

  void updateStructures() override {
    for (Tree& tree : trees_) tree.rebuild(false);
  }

  void searchOverlaps() override {
    if (!buffer_.empty()) {
      pairs_.dropIf([this](Pair pair) {
        return (is_buffered_[pair.a] | is_buffered_[pair.b]) != 0 &&
               !broadmark::overlaps(fat_boxes_[pair.a], fat_boxes_[pair.b]);
      });
      found_.clear();
      for (const std::uint32_t body : buffer_) findCandidates(body);
      pairs_.insert(found_);
    }
    if (!moved_.empty()) {
      pairs_.update(
          *team_, [this](Pair pair) { return (has_moved_[pair.a] | has_moved_[pair.b]) != 0; },
          [this](Pair pair) { return overlap(pair); });
    }
    pairs_.endFrame();
  }

  [[nodiscard]] PairRuns overlaps() const override { return pairs_.overlaps(); }
  [[nodiscard]] PairEvents events() const override { return pairs_.events(); }

  void visitCounters(const CounterVisitor& visit) const override {
    visit("moves", moved_.size());
    visit("enlarged boxes", buffer_.size());
    pairs_.visitCounters(visit);
  }

  [[nodiscard]] std::string validate() const override {
    for (std::uint32_t body = 0; body < boxes_.size(); ++body) {
      if ((proxies_[body] == kNoProxy) != isEmpty(boxes_[body]))
        return "the number of boxes in the trees is not that of bodies";
      if (!isEmpty(boxes_[body]) && !contains(fat_boxes_[body], boxes_[body]))
        return "a body has left its enlarged box";
    }
    return pairs_.validate(
        [this](Pair pair) { return !isEmpty(boxes_[pair.a]) && !isEmpty(boxes_[pair.b]); },
        [this](Pair pair) { return overlap(pair); });
  }

 private:
  [[nodiscard]] bool overlap(Pair pair) const {
    return broadmark::overlaps(boxes_[pair.a], boxes_[pair.b]);
  }

  void move(std::uint32_t body, const Aabb& box) {
    boxes_[body] = box;
    moved_.push_back(body);
    has_moved_[body] = 1;
    int& proxy = proxies_[body];
    if (isEmpty(box)) {
      if (proxy == kNoProxy) return;
      trees_[is_static_[body]].remove(std::exchange(proxy, kNoProxy));
      fat_boxes_[body] = kEmptyBox;
    } else if (proxy == kNoProxy) {
      const std::size_t layer = filter_.layerOf(body);  // a LiveFilter's may have changed
      is_static_[body] = static_layers_.contains(layer) ? 1 : 0;
      fat_boxes_[body] = enlargedBox(box);
      proxy = trees_[is_static_[body]].add(fat_boxes_[body], std::uint64_t{1} << layer, body);
    } else if (!contains(fat_boxes_[body], box)) {
      fat_boxes_[body] = enlargedBox(box);
      trees_[is_static_[body]].setBox(proxy, fat_boxes_[body]);
    } else {
      return;
    }
    buffer_.push_back(body);
    is_buffered_[body] = 1;
  }

  /// As b3ComputeShapeMargin(): an eighth of the distance from the centre to a corner, but limited.
  [[nodiscard]] Aabb enlargedBox(const Aabb& box) const {
    constexpr float kShareOfExtent = 0.125F;
    float diagonal = 0;
    for (int axis = 0; axis < 3; ++axis) {
      diagonal = std::hypot(diagonal, box.max[axis] - box.min[axis]);
    }
    const auto limit = static_cast<float>(max_enlargement_);
    return enlarged(box, std::min(limit, kShareOfExtent * diagonal / 2));
  }

  void findCandidates(std::uint32_t body) {
    if (proxies_[body] == kNoProxy) return;
    const std::uint64_t layers = filter_.matrix().rows()[filter_.layerOf(body)];
    const auto add = [&](std::uint32_t other) {
      if (other == body || (other < body && is_buffered_[other] != 0)) return;
      if (!is_layered_ && !filter_.wanted(body, other)) return;
      const Pair pair = orderedPair(body, other);
      if (!pairs_.contains(pair)) found_.push_back(pair);
    };
    trees_[0].query(fat_boxes_[body], layers, add);
    if (is_static_[body] == 0) trees_[1].query(fat_boxes_[body], layers, add);
  }

  double max_enlargement_ = B3_MAX_AABB_MARGIN;
  CollisionFilter filter_;
  bool is_layered_ = false;  ///< the filter consists of layers alone
  NonCollidingLayers static_layers_;
  ThreadTeam* team_ = nullptr;
  std::array<Tree, 2> trees_;  ///< of moving bodies, and of static geometry
  // By body.
  std::vector<Aabb> boxes_;
  std::vector<Aabb> fat_boxes_;
  std::vector<int> proxies_;
  std::vector<std::uint8_t> is_static_;
  std::vector<std::uint8_t> has_moved_;    ///< in this frame, or appeared or vanished
  std::vector<std::uint8_t> is_buffered_;  ///< in this frame
  CandidatePairs pairs_;                   ///< wanted, with enlarged boxes that overlap
  // Of the current frame.
  std::vector<std::uint32_t> moved_;
  std::vector<std::uint32_t> buffer_;  ///< bodies with a new enlarged box, or none any more
  std::vector<Pair> found_;
};

class Rebuilt final : public BoxBroadPhase {
 public:
  void initialize(const SceneInfo& scene, const Frame& first,
                  ExecutionContext& execution) override {
    BoxBroadPhase::initialize(scene, first, execution);
    updateStructures();
  }

  void updateStructures() override {
    for (; proxies_.size() > boxes().size(); proxies_.pop_back()) tree_.remove(proxies_.back());
    for (std::uint32_t body = 0; body < proxies_.size(); ++body) {
      tree_.setBox(proxies_[body], boxes()[body]);
    }
    while (proxies_.size() < boxes().size()) {
      const auto body = static_cast<std::uint32_t>(proxies_.size());
      proxies_.push_back(tree_.add(boxes()[body], 1, body));
    }
    tree_.rebuild(true);
  }

 private:
  void findPairs() override {
    for (std::uint32_t body = 0; body < boxes().size(); ++body) {
      tree_.query(boxes()[body], 1, [&](std::uint32_t other) {
        if (body < other) pairs().add(body, other);
      });
    }
  }

  Tree tree_;
  std::vector<int> proxies_;  ///< by body
};

}  // namespace

std::vector<Algorithm> variants() {
  const Algorithm family = {
      .family = "Box3D",
      .traits = {.library_aborts = true, .instance_per_world = true, .max_objects = kMaxBodies},
      .description = {.principle = "tree",
                      .time = "O(m log n + k), m bodies that move",
                      .space = "O(n + k)",
                      .source = "Box3D 0.1, b3DynamicTree"}};
  Algorithm tree = family;
  tree.id = "box3d-tree";
  tree.summary = "Box3D's dynamic tree of enlarged boxes, rebuilt where they have grown";
  tree.traits.incremental = true;
  tree.traits.events = true;
  tree.traits.changing_worlds = ChangingWorlds::native;
  tree.description.optimisations = "incremental, enlarged boxes, a tree for static geometry";
  tree.create = [] { return std::make_unique<EnlargedBoxes>(); };
  Algorithm rebuilt = family;
  rebuilt.id = "box3d-rebuild";
  rebuilt.summary = "Box3D's dynamic tree, rebuilt every frame and queried by every body";
  rebuilt.traits.changing_worlds = ChangingWorlds::compacted;
  rebuilt.description.time = "O(n log n + k)";
  rebuilt.create = [] { return std::make_unique<Rebuilt>(); };
  return {tree, rebuilt};
}

}  // namespace broadmark::box3d_dynamic_tree

BROADMARK_PLUGIN(broadmark::box3d_dynamic_tree::variants);
