// FCL's dynamic trees of boxes (DynamicAABBTreeCollisionManager), with linked nodes or, in the
// other variant, nodes in an array: a leaf with a changed box is removed and reinserted, and the
// tree is traversed against itself. O(m log n + n + k) a frame for m moved bodies, if the tree is
// balanced. O(n + k) space.
//
// As recommended by the library: all objects are registered at once, then setup() is called; in a
// frame, update() with the moved objects ("update the manager by explicitly given the set of
// objects update"). update() without arguments refits the tree to all of them, which is faster, but
// leaves a tree of large nodes when bodies pass each other. If more than half of the bodies have
// left their boxes entirely, all are registered again, which is faster than moving that many
// leaves. All objects share one unused shape; their boxes are set directly.
//
// The array variant has bugs in its update(): it reinserts a leaf near its old position, however
// far it moved, loses a single leaf, and when it balances the tree from the top it renumbers the
// leaves, and updates wrong ones afterwards. There a moved body is unregistered and registered
// again; all are registered at once only initially, as that leaks memory. When the array is full
// and grows, it reads two boxes from the old array after freeing it: so growth is avoided. Spare
// bodies are registered with the others and removed again, which leaves room for later bodies; if
// that is not enough, all are registered again with twice the room.
//
// The library works in double precision. It treats boxes as equal that differ by less than 100
// epsilon of a corner's distance from the origin, so each box is enlarged by more than that; and a
// leaf with a new box inside its old one keeps the old one. Pairs are tested with the original
// boxes, so the answer is exact.
//
// No drawing: the library does not expose its trees.
//
// Paper: J. Pan, S. Chitta, D. Manocha, "FCL: A General Purpose Library for Collision and Proximity
// Queries", ICRA 2012. Library: the Flexible Collision Library.

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/broadphase/broadphase_dynamic_AABB_tree_array.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision_object.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <deque>
#include <memory>
#include <type_traits>
#include <vector>

#include "broadmark/algorithm.h"
#include "broadmark/error.h"
#include "moved_boxes.h"
#include "variants.h"

namespace broadmark::fcl_tree {
namespace {

/// A body as an object of the library.
class Body final : public fcl::CollisionObjectd {
 public:
  Body(const std::shared_ptr<fcl::CollisionGeometryd>& shape, std::uint32_t number)
      : fcl::CollisionObject<double>(shape), number_(number) {}

  [[nodiscard]] std::uint32_t number() const { return number_; }

  /// Sets the box. Returns whether the body has left the former box.
  bool place(const Aabb& box) {
    const fcl::AABBd before = aabb;
    double farthest = 0;
    for (int axis = 0; axis < 3; ++axis) {
      farthest = std::max<double>({farthest, std::fabs(box.min[axis]), std::fabs(box.max[axis])});
    }
    constexpr double kRim = 1e-13;  // above 100 epsilon times the square root of 3
    for (int axis = 0; axis < 3; ++axis) {
      aabb.min_[axis] = box.min[axis] - kRim * farthest;
      aabb.max_[axis] = box.max[axis] + kRim * farthest;
    }
    return !aabb.overlap(before);
  }

 private:
  std::uint32_t number_;
};

using Bodies = std::vector<fcl::CollisionObjectd*>;
using Nodes = fcl::DynamicAABBTreeCollisionManagerd;
using Array = fcl::DynamicAABBTreeCollisionManager_Arrayd;

void update(Nodes& manager, const Bodies& moved) {
  if (!moved.empty()) manager.update(moved);  // without objects it would balance the tree further
}

void update(Array& manager, const Bodies& moved) {
  for (fcl::CollisionObjectd* const body : moved) {
    manager.unregisterObject(body);
    manager.registerObject(body);
  }
}

/// Whether the number of bodies must not exceed that of the last registration.
template <class Manager>
constexpr bool kHasFixedRoom = std::is_same_v<Manager, Array>;

template <class Manager>
class Fcl final : public MovedBoxes {
 public:
  void answerQueries(AnswerKind) override { answers_queries_ = true; }

  void initialize(const SceneInfo& scene, const Frame& first,
                  ExecutionContext& execution) override {
    if (answers_queries_ && !scene.all_present) {
      throw UnsupportedError("queries in scenes where bodies appear or disappear");
    }
    MovedBoxes::initialize(scene, first, execution);
    max_bodies_ = scene.objects;
    for (std::uint32_t body = 0; body < boxes().size(); ++body) create(body);
    registerAll();
  }

  void updateStructures() override {
    for (; bodies_.size() > boxes().size(); bodies_.pop_back()) {
      manager_.unregisterObject(&bodies_.back());
    }
    const std::size_t known = bodies_.size();
    std::size_t jumps = boxes().size() - known;
    updated_.clear();
    for (const std::uint32_t number : moved()) {
      if (number < known) {
        jumps += bodies_[number].place(boxes()[number]) ? 1 : 0;
        updated_.push_back(&bodies_[number]);
      } else {
        create(number);
      }
    }
    if (kHasFixedRoom<Manager> ? bodies_.size() > capacity_ : jumps > bodies_.size() / 2) {
      return registerAll();
    }
    update(manager_, updated_);
    for (std::size_t body = known; body < bodies_.size(); ++body) {
      manager_.registerObject(&bodies_[body]);
    }
  }

 private:
  void create(std::uint32_t number) { bodies_.emplace_back(shape_, number).place(boxes()[number]); }

  void registerAll() {
    updated_.clear();
    for (Body& body : bodies_) updated_.push_back(&body);
    std::deque<Body> spare = spareBodies();
    for (Body& body : spare) updated_.push_back(&body);
    manager_.clear();
    manager_.registerObjects(updated_);
    manager_.setup();
    for (Body& body : spare) manager_.unregisterObject(&body);
    capacity_ = updated_.size();
  }

  /// Enough to double the number of bodies, up to the scene's maximum.
  [[nodiscard]] std::deque<Body> spareBodies() const {
    std::deque<Body> spare;
    if (!kHasFixedRoom<Manager> || bodies_.empty()) return spare;
    const std::size_t room = std::min(2 * bodies_.size(), max_bodies_);
    for (std::size_t body = bodies_.size(); body < room; ++body) {
      spare.emplace_back(shape_, 0).place(boxes()[0]);
    }
    return spare;
  }

  void findPairs() override { manager_.collide(this, report); }

  /// A query and the algorithm that answers it.
  struct QueryContext {
    Fcl* tree;
    const QueryBatch* batch;
    std::uint32_t index;
  };

  void findHits(const QueryBatch& batch) override {
    for (std::uint32_t i = 0; i < batch.queries.size(); ++i) {
      Body query(shape_, i);
      query.place(batch.queries[i].box);
      QueryContext context{this, &batch, i};
      manager_.collide(&query, &context, reportHit);
    }
  }

  static bool reportHit(fcl::CollisionObjectd* found, fcl::CollisionObjectd* /*query*/,
                        void* data) {
    const auto& [tree, batch, index] = *static_cast<QueryContext*>(data);
    const std::uint32_t body = static_cast<Body*>(found)->number();
    if (hits(batch->kind, batch->queries[index], tree->boxes()[body])) {
      tree->pairs().addHit(index, body);
    }
    constexpr bool kEnough = false;
    return kEnough;
  }

  static bool report(fcl::CollisionObjectd* a, fcl::CollisionObjectd* b, void* self) {
    auto& tree = *static_cast<Fcl*>(self);
    const std::uint32_t first = static_cast<Body*>(a)->number();
    const std::uint32_t second = static_cast<Body*>(b)->number();
    if (broadmark::overlaps(tree.boxes()[first], tree.boxes()[second])) {
      tree.pairs().add(first, second);
    }
    constexpr bool kEnough = false;
    return kEnough;
  }

  bool answers_queries_ = false;
  std::shared_ptr<fcl::CollisionGeometryd> shape_ = std::make_shared<fcl::Sphered>(1);
  std::deque<Body> bodies_;  ///< the manager holds their addresses
  Bodies updated_;
  Manager manager_;
  std::size_t max_bodies_ = 0;  ///< bodies of the scene
  std::size_t capacity_ = 0;    ///< number of bodies in the last registration
};

}  // namespace

std::vector<Algorithm> variants() {
  const Algorithm family = {
      .family = "FCL",
      .traits = {.incremental = true,
                 .queries = {AnswerKind::boxes},
                 .library_allocates = true,
                 .changing_worlds = ChangingWorlds::compacted,
                 .instance_per_world = true},
      .description = {.principle = "tree",
                      .optimisations = "persistent tree",
                      .time = "O(m log n + n + k), m bodies that move",
                      .space = "O(n + k)",
                      .source = "FCL, DynamicAABBTreeCollisionManager; Pan et al. 2012"}};
  Algorithm array = variantOf<Fcl<Array>>(family, "fcl-array",
                                          "FCL's dynamic tree of boxes, with nodes in an array");
  array.traits.library_leaks = true;
  return {variantOf<Fcl<Nodes>>(family, "fcl",
                                "FCL's dynamic tree of boxes, with nodes linked by pointers"),
          array};
}

}  // namespace broadmark::fcl_tree
