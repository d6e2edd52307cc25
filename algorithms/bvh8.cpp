// The bounding volume hierarchy with which the library (broadphase/) answers queries: eight
// children to a node, refitted around the bodies that moved, rebuilt as it degrades. See
// queries/query_tree.cpp. Pairs are found by a query for each body. O(n log n + k) time, O(m log n)
// to update the tree for m moved bodies; O(n + k) space.

#include <memory>
#include <optional>
#include <vector>

#include "moved_boxes.h"
#include "queries/query_tree.h"
#include "variants.h"

namespace broadmark::bvh8 {
namespace {

namespace bp = broadmark::broadphase;

bp::Box libraryBox(const Aabb& box) {
  return {{box.min[0], box.min[1], box.min[2]}, {box.max[0], box.max[1], box.max[2]}};
}

class Bvh8 final : public MovedBoxes {
 public:
  void initialize(const SceneInfo& scene, const Frame& first,
                  ExecutionContext& execution) override {
    MovedBoxes::initialize(scene, first, execution);
    tree_.emplace(execution.isa());
    updateStructures();
  }

  void updateStructures() override {
    if (bodies_ == boxes().size()) {
      tree_->markDirty(moved());
    } else {
      tree_->markAllDirty();
    }
    bodies_ = boxes().size();
    tree_->refresh({boxes(), no_filter_}, team());
  }

 private:
  void findPairs() override {
    box_queries_.clear();
    for (const Aabb& box : boxes()) box_queries_.push_back({libraryBox(box)});
    tree_->overlapping(box_queries_, found_bodies_, team());
    for (std::uint32_t a = 0; a < boxes().size(); ++a) {
      for (const std::uint32_t b : found_bodies_[a]) {
        if (a < b) pairs().add(a, b);
      }
    }
  }

  void findHits(const QueryBatch& batch) override {
    switch (batch.kind) {
      case AnswerKind::boxes:
        box_queries_.clear();
        for (const Query& query : batch.queries) box_queries_.push_back({libraryBox(query.box)});
        tree_->overlapping(box_queries_, found_bodies_, team());
        return addHits(found_bodies_, [](std::uint32_t body) { return body; });
      case AnswerKind::nearest:
        nearest_queries_.clear();
        for (const auto& [box, motion] : batch.queries) {
          nearest_queries_.push_back(
              {{box.min[0], box.min[1], box.min[2]}, std::uint32_t{kNearestBodies}});
        }
        tree_->nearest(nearest_queries_, neighbours_, team());
        return addHits(neighbours_, [](const bp::Neighbour& found) { return found.body; });
      default:
        casts_.clear();
        for (const auto& [box, motion] : batch.queries) {
          casts_.push_back({libraryBox(box), {motion[0], motion[1], motion[2]}});
        }
        tree_->cast(casts_, bp::Hits::all, cast_hits_, team());
        return addHits(cast_hits_, [](const bp::CastHit& hit) { return hit.body; });
    }
  }

  template <class T, class BodyOf>
  void addHits(const bp::QueryResults<T>& results, BodyOf body_of) {
    for (std::uint32_t query = 0; query < results.size(); ++query) {
      for (const T& found : results[query]) pairs().addHit(query, body_of(found));
    }
  }

  CollisionFilter no_filter_;
  std::optional<bp::QueryTree> tree_;
  std::size_t bodies_ = 0;  ///< of the last frame
  std::vector<bp::BoxQuery> box_queries_;
  std::vector<bp::Cast> casts_;
  std::vector<bp::NearestQuery> nearest_queries_;
  bp::QueryResults<std::uint32_t> found_bodies_;
  bp::QueryResults<bp::CastHit> cast_hits_;
  bp::QueryResults<bp::Neighbour> neighbours_;
};

}  // namespace

std::vector<Algorithm> variants() {
  const Algorithm family = {
      .family = "BVH8",
      .traits = {.incremental = true,
                 .queries = {AnswerKind::boxes, AnswerKind::rays, AnswerKind::sweeps,
                             AnswerKind::nearest},
                 .changing_worlds = ChangingWorlds::compacted,
                 .instance_per_world = true},
      .description = {.principle = "tree",
                      .optimisations = "wide nodes, vector tests, refitting",
                      .time = "O(n log n + k)",
                      .space = "O(n + k)",
                      .source = "Broadmark; Wald, Benthin and Boulos 2008; Wald 2007"}};
  return {
      variantOf<Bvh8>(family, "bvh8", "query tree of Broadmark's library: wide nodes, refitted",
                      {.vectorised = true}),
      variantOf<Bvh8>(family, "bvh8-mt", "query tree of Broadmark's library, on several threads",
                      {.parallel = true, .vectorised = true})};
}

}  // namespace broadmark::bvh8
