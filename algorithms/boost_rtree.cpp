// Boost's R-tree: nodes of up to 8 children, each with its bounding box; one query per body. The
// packed variant rebuilds the tree every frame from all boxes at once; the incremental one removes
// and reinserts moved bodies. O(n log n + k) time, and O(m log n) to update the tree for m moved
// bodies, if few boxes of a node overlap. O(n + k) space.
//
// The manual ("R-tree", "Introduction" and "Creation and Modification") recommends the packing
// algorithm, by the range constructor, if all values are known: both construction and queries are
// faster; a changed value must be removed and inserted. Of the three balancing algorithms in
// "Performance", the quadratic one is between the linear one, with the fastest insertion, and the
// R*-tree, with the fastest queries.
//
// Queries are in the order of the tree, so that successive queries read cached nodes. Each pair is
// found from both sides, and reported from one. Bounds are only compared, as floats: the answer is
// exact.
//
// No drawing: the library does not expose its nodes.
//
// Papers: A. Guttman, "R-Trees: A Dynamic Index Structure for Spatial Searching", SIGMOD 1984;
// S. Leutenegger et al., "STR: A Simple and Efficient Algorithm for R-Tree Packing", ICDE 1997.
// Library: Boost.Geometry, "Spatial Indexes".

#define BOOST_ALLOW_DEPRECATED_HEADERS  // suppresses Boost's own notes
#include <boost/geometry/algorithms/covered_by.hpp>
#include <boost/geometry/algorithms/distance.hpp>  // for nearest(), in Boost 1.83
#include <boost/geometry/core/cs.hpp>
#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <boost/geometry/strategies/strategies.hpp>
#include <boost/iterator/function_output_iterator.hpp>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "broadmark/algorithm.h"
#include "moved_boxes.h"
#include "variants.h"

namespace broadmark::boost_rtree {
namespace {

namespace index = boost::geometry::index;
using Point = boost::geometry::model::point<float, 3, boost::geometry::cs::cartesian>;
using Box = boost::geometry::model::box<Point>;
using Value = std::pair<Box, std::uint32_t>;
/// Values are equal if their bodies are.
struct SameBody {
  bool operator()(const Value& a, const Value& b) const { return a.second == b.second; }
};
using Tree = index::rtree<Value, index::quadratic<8>, index::indexable<Value>, SameBody>;

Value valueOf(const Aabb& box, std::uint32_t body) {
  return {Box(Point(box.min[0], box.min[1], box.min[2]), Point(box.max[0], box.max[1], box.max[2])),
          body};
}

bool isPresent(const Value& value) {
  return value.first.min_corner().get<0>() <= value.first.max_corner().get<0>();
}

class RTree final : public MovedBoxes {
 public:
  explicit RTree(bool incremental) : incremental_(incremental) {}

  void initialize(const SceneInfo& scene, const Frame& first,
                  ExecutionContext& execution) override {
    MovedBoxes::initialize(scene, first, execution);
    pack();
    if (!incremental_) return;
    for (std::uint32_t body = 0; body < boxes().size(); ++body) {
      values_.push_back(valueOf(boxes()[body], body));
    }
  }

  void updateStructures() override { incremental_ ? update() : pack(); }

  [[nodiscard]] std::string validate() const override {
    const auto present = std::ranges::count_if(boxes(), std::not_fn(isEmpty));
    if (std::cmp_equal(tree_.size(), present)) return "";
    return "the number of values in the tree is not that of bodies";
  }

 private:
  /// Builds the tree from all boxes.
  void pack() {
    packed_.clear();
    for (std::uint32_t body = 0; body < boxes().size(); ++body) {
      if (!isEmpty(boxes()[body])) packed_.push_back(valueOf(boxes()[body], body));
    }
    tree_ = Tree(packed_);
  }

  void update() {
    for (; values_.size() > boxes().size(); values_.pop_back()) tree_.remove(values_.back());
    for (const std::uint32_t body : moved()) {
      const Value value = valueOf(boxes()[body], body);
      if (body < values_.size()) {
        if (isPresent(values_[body])) tree_.remove(values_[body]);
        values_[body] = value;
      } else {
        values_.push_back(value);
      }
      if (isPresent(value)) tree_.insert(value);
    }
  }

  void findHits(const QueryBatch& batch) override {
    for (std::uint32_t i = 0; i < batch.queries.size(); ++i) {
      const auto add = [&](const Value& found) { pairs().addHit(i, found.second); };
      const auto found = boost::make_function_output_iterator(add);
      const Box box = valueOf(batch.queries[i].box, 0).first;
      if (batch.kind == AnswerKind::boxes) {
        tree_.query(index::intersects(box), found);
      } else {
        tree_.query(index::nearest(box.min_corner(), unsigned{kNearestBodies}), found);
      }
    }
  }

  void findPairs() override {
    for (const Value& value : tree_) {
      const auto add = [&](const Value& found) {
        if (value.second < found.second) pairs().add(value.second, found.second);
      };
      tree_.query(index::intersects(value.first), boost::make_function_output_iterator(add));
    }
  }

  bool incremental_;
  std::vector<Value> packed_;  ///< of the present bodies
  std::vector<Value> values_;  ///< if incremental: by body, also of absent ones
  Tree tree_;
};

}  // namespace

std::vector<Algorithm> variants() {
  const Algorithm family = {
      .family = "Boost R-tree",
      .traits = {.queries = {AnswerKind::boxes, AnswerKind::nearest},
                 .library_allocates = true,
                 .changing_worlds = ChangingWorlds::compacted,
                 .instance_per_world = true},
      .description = {
          .principle = "tree",
          .time = "O(n log n + k)",
          .space = "O(n + k)",
          .source = "Boost.Geometry, index::rtree; Guttman 1984; Leutenegger et al. 1997"}};
  std::vector<Algorithm> all = {
      variantOf<RTree>(family, "boost-rtree-packed",
                       "Boost.Geometry's R-tree, packed from scratch every frame", {},
                       /*incremental=*/false),
      variantOf<RTree>(
          family, "boost-rtree",
          "Boost.Geometry's R-tree, from which moved bodies are removed and inserted again", {},
          /*incremental=*/true)};
  all[0].description.optimisations = "bulk loading";
  all[1].traits.incremental = true;
  all[1].description.optimisations = "persistent tree";
  return all;
}

}  // namespace broadmark::boost_rtree
