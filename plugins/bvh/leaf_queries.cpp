// The library bvh: a binary bounding volume hierarchy, built from scratch each frame by the surface
// area heuristic over eight bins, its builder of low quality, which is the fastest. By default it
// divides nodes down to single boxes; here it keeps those of up to eight, in half of the time.
// O(n log n + k) time for boxes of similar size, O(n) space.
//
// The library is made for rays; its traversal takes any test of nodes. Here each leaf, which holds
// up to eight boxes, queries the hierarchy once with its bounds. Boxes are copied into the order of
// the leaves, as the library recommends. Of two leaves, the one that comes first finds the pairs.
// Bounds are minima and maxima of floats, so the answer is exact.
//
// Library: bvh v2, A. Pérard-Gayot.

#include <bvh/v2/default_builder.h>
#include <bvh/v2/stack.h>

#include <cstdint>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "broadmark/plugin.h"

namespace broadmark::bvh_leaf_queries {
namespace {

using Node = bvh::v2::Node<float, 3>;
using Vec = bvh::v2::Vec<float, 3>;
using BBox = bvh::v2::BBox<float, 3>;
using Builder = bvh::v2::DefaultBuilder<Node>;

Vec vectorOf(const std::array<float, 4>& corner) { return {corner[0], corner[1], corner[2]}; }

bool overlap(const Node& a, const Node& b) {
  bool separated = false;
  for (std::size_t min = 0; min < a.bounds.size(); min += 2) {
    separated |= (a.bounds[min] > b.bounds[min + 1]) | (b.bounds[min] > a.bounds[min + 1]);
  }
  return !separated;
}

class LeafQueries final : public BoxBroadPhase {
 public:
  void initialize(const SceneInfo& scene, const Frame& first,
                  ExecutionContext& execution) override {
    BoxBroadPhase::initialize(scene, first, execution);
    updateStructures();
  }

  void updateStructures() override {
    bounds_.clear();
    centers_.clear();
    for (const Aabb& box : boxes()) {
      bounds_.emplace_back(vectorOf(box.min), vectorOf(box.max));
      centers_.push_back(vectorOf(box.min) * 0.5F + vectorOf(box.max) * 0.5F);  // no overflow
    }
    if (bounds_.empty()) return;
    Builder::Config config;
    config.quality = Builder::Quality::Low;
    config.min_leaf_size = config.max_leaf_size;
    tree_ = Builder::build(bounds_, centers_, config);
    in_leaf_order_.clear();
    for (const std::size_t body : tree_.prim_ids) in_leaf_order_.push_back(boxes()[body]);
  }

 private:
  void findPairs() override {
    if (boxes().empty()) return;
    for (const Node& leaf : tree_.nodes) {
      if (!leaf.is_leaf()) continue;
      const std::size_t begin = leaf.index.first_id();
      const std::size_t end = begin + leaf.index.prim_count();
      for (std::size_t i = begin; i < end; ++i) addPairs(i, i + 1, end);
      tree_.traverse_top_down<false>(
          tree_.get_root().index, stack_,
          [&](std::size_t other_begin, std::size_t other_end) {
            if (other_begin <= begin) return false;
            for (std::size_t i = begin; i < end; ++i) addPairs(i, other_begin, other_end);
            return false;
          },
          [&](const Node& left, const Node& right) {
            return std::tuple(overlap(leaf, left), overlap(leaf, right), false);
          });
    }
  }

  /// Tests a box against others. All are places in the order of the leaves.
  void addPairs(std::size_t place, std::size_t begin, std::size_t end) {
    for (std::size_t other = begin; other < end; ++other) {
      if (!broadmark::overlaps(in_leaf_order_[place], in_leaf_order_[other])) continue;
      pairs().add(static_cast<std::uint32_t>(tree_.prim_ids[place]),
                  static_cast<std::uint32_t>(tree_.prim_ids[other]));
    }
  }

  std::vector<BBox> bounds_;
  std::vector<Vec> centers_;
  bvh::v2::Bvh<Node> tree_;
  std::vector<Aabb> in_leaf_order_;
  bvh::v2::GrowingStack<Node::Index> stack_;
};

}  // namespace

std::vector<Algorithm> variants() {
  return {{.id = "bvh",
           .family = "bvh",
           .summary = "the library bvh's hierarchy, from scratch every frame, queried by each leaf",
           .traits = {.library_allocates = true,
                      .changing_worlds = ChangingWorlds::compacted,
                      .max_objects = Node::Index::max_first_id / 2},
           .description = {.principle = "tree",
                           .optimisations = "leaves of up to eight boxes",
                           .time = "O(n log n + k)",
                           .space = "O(n + k)",
                           .source = "bvh v2, A. Pérard-Gayot"},
           .create = [] { return std::make_unique<LeafQueries>(); }}};
}

}  // namespace broadmark::bvh_leaf_queries

BROADMARK_PLUGIN(broadmark::bvh_leaf_queries::variants);
