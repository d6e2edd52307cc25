// Bullet's dynamic bounding volume trees (btDbvtBroadphase): one tree of moving boxes, one of boxes
// at rest. A leaf that its box has left is removed and reinserted, enlarged by a margin; pairs are
// stored in a hash table. The forward variant queries the trees at each insertion, the deferred one
// traverses both trees against each other once a frame. O(m log n + k) a frame for m moving bodies,
// if the tree is balanced. O(n + k) space.
//
// The answer is what Bullet's user gets: the pairs of overlapping leaves. A leaf extends beyond its
// box by up to twice the margin, after its body has moved from one end of it to the other. If the
// box shrinks it would extend further: the body is then reinserted (setAabbForceUpdate, which
// Bullet provides for that). By default Bullet checks only a tenth of its pairs a frame for stale
// ones: here all of them are checked, as they would accumulate.
//
// Events come from the callbacks of Bullet's hash table for added and removed pairs. A frame
// without changes is not passed to Bullet then.
//
// Bullet's margin is a global variable. An instance sets it during a call and restores the former
// value, and the host prevents concurrent use (traits.exclusive): so instances with different
// margins may coexist.
//
// Paper: the trees follow N. Presson's in Bullet; for the idea see G. van den Bergen, "Efficient
// Collision Detection of Complex Deformable Models using AABB Trees", 1997. Library: Bullet 3.

#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "broadmark/exclusive_use.h"
#include "broadmark/non_colliding_layers.h"
#include "bullet_broad_phase.h"
#include "variants.h"

namespace broadmark::dbvt {
namespace {

using Tree = btDbvtBroadphase;

btVector3 vectorOf(const std::array<float, 4>& corner) { return {corner[0], corner[1], corner[2]}; }

Aabb boxOf(const btDbvtVolume& volume) {
  const btVector3& min = volume.Mins();
  const btVector3& max = volume.Maxs();
  return {{min.x(), min.y(), min.z(), 0}, {max.x(), max.y(), max.z(), 0}};
}

/// Sets Bullet's process-wide margin during its lifetime. Of the functions called here only setAabb
/// reads it.
class ScopedMargin {
 public:
  explicit ScopedMargin(float margin) : before_(std::exchange(gDbvtMargin, margin)) {}
  ~ScopedMargin() { gDbvtMargin = before_; }
  ScopedMargin(const ScopedMargin&) = delete;
  ScopedMargin& operator=(const ScopedMargin&) = delete;

 private:
  float before_;
};

/// Calls visit(body) for each leaf that a query of Bullet's finds.
template <class Visit>
struct Candidates final : btBroadphaseRayCallback {
  explicit Candidates(Visit on_leaf) : visit(on_leaf) {}
  bool process(const btBroadphaseProxy* proxy) override {
    visit(static_cast<std::uint32_t>(proxy->m_uniqueId) - 1);
    return true;
  }
  Visit visit;
};

class Dbvt final : public BulletBroadPhase {
 public:
  explicit Dbvt(bool deferred) { tree_.m_deferedcollide = deferred; }
  Dbvt(const Dbvt&) = delete;
  Dbvt& operator=(const Dbvt&) = delete;
  ~Dbvt() override {
    // destroyProxy would search all pairs for each proxy.
    for (btDbvtProxy* const proxy : proxies_) {
      if (proxy != nullptr) btAlignedFree(proxy);
    }
  }

  void visitParameters(const ParameterVisitor& visit) override {
    visit({"margin", "margin added to a leaf that its box left, in world units", &margin_, 0, 1e6});
  }

  /// The maximum extent of a leaf beyond its box.
  [[nodiscard]] float margin() const override { return 2 * static_cast<float>(margin_); }

  void answerQueries(AnswerKind) override {
    answers_queries_ = true;
    tree_.m_deferedcollide = true;  // else a moved leaf is tested for pairs
  }

  void initialize(const SceneInfo& scene, const Frame& first,
                  ExecutionContext& execution) override {
    BulletBroadPhase::initialize(scene, first, execution);
    filterPairs(*tree_.m_paircache);
    if (reportsEvents()) tree_.m_paircache->setInternalGhostPairCallback(&changes_);
    proxies_.resize(boxes().size(), nullptr);
    const std::vector<std::uint32_t> bodies = first.presentBodies();
    putToRest(scene.filter, bodies);
    for (const std::uint32_t body : bodies) {
      if (proxies_[body] == nullptr) create(body);
    }
    if (answers_queries_) return;
    updatePairs();
    if (reportsEvents()) gatherEvents();
  }

  void updateStructures() override {
    const ScopedMargin in_force(static_cast<float>(margin_));
    const unsigned updates_before = tree_.m_updates_done;
    reinsertions_ = 0;
    destroyVanished();
    for (const std::uint32_t body : moved()) {
      if (isEmpty(boxes()[body])) continue;
      if (proxies_[body] == nullptr) {
        create(body);
        continue;
      }
      if (proxies_[body]->stage == Tree::STAGECOUNT) ++reinsertions_;  // from the tree at rest
      move(body);
    }
    reinsertions_ += tree_.m_updates_done - updates_before;
  }

  void drawStructure(DebugDraw& draw) const override {
    drawTree(draw, tree_.m_sets[Tree::DYNAMIC_SET], StructureRole::moving_node);
    drawTree(draw, tree_.m_sets[Tree::FIXED_SET], StructureRole::resting_node);
  }

  void visitCounters(const CounterVisitor& visit) const override {
    visit("moves", moved().size());
    visit("reinsertions", reinsertions_);
  }

  [[nodiscard]] std::string validate() const override {
    for (std::uint32_t body = 0; body < proxies_.size(); ++body) {
      if ((proxies_[body] == nullptr) != isEmpty(boxes()[body]))
        return "a body appeared or disappeared unnoticed";
      if (proxies_[body] == nullptr) continue;
      if (!contains(leafOf(body), boxes()[body])) return "a box has left its leaf";
      if (reachesTooFar(body)) return "a leaf reaches beyond the margin";
    }
    return {};
  }

 private:
  /// A pair that was removed and added again has neither ended nor begun.
  void gatherEvents() {
    std::ranges::sort(changes_.added);
    std::ranges::sort(changes_.removed);
    findEvents([this](std::vector<Pair>& began, std::vector<Pair>& ended) {
      std::ranges::set_difference(changes_.added, changes_.removed, std::back_inserter(began));
      std::ranges::set_difference(changes_.removed, changes_.added, std::back_inserter(ended));
    });
    changes_.added.clear();
    changes_.removed.clear();
  }

  void findPairs() override {
    if (reportsEvents()) {
      if (!moved().empty()) updatePairs();
      gatherEvents();
      return;
    }
    updatePairs();
    addPairs(*tree_.m_paircache, [](std::uint32_t, std::uint32_t) { return true; });
  }

  void findHits(const QueryBatch& batch) override {
    largest_ = largestCoordinate(boxes());
    for (std::uint32_t i = 0; i < batch.queries.size(); ++i) {
      const Query& query = batch.queries[i];
      Candidates found([&](std::uint32_t body) {
        if (hits(batch.kind, query, boxes()[body])) pairs().addHit(i, body);
      });
      if (batch.kind == AnswerKind::boxes) {
        tree_.aabbTest(vectorOf(query.box.min), vectorOf(query.box.max), found);
      } else {
        cast(query, found);
      }
    }
  }

  /// As btCollisionWorld's rayTest() and convexSweepTest() do, but with a slightly larger box:
  /// Bullet rounds, and passes over a leaf without thickness at the start of a ray.
  void cast(const Query& query, btBroadphaseRayCallback& found) {
    constexpr float kMargin = 16 * std::numeric_limits<float>::epsilon();
    const btVector3 min = vectorOf(query.box.min);
    const btVector3 max = vectorOf(query.box.max);
    const btVector3 start = min / 2 + max / 2;
    const btVector3 motion = vectorOf(query.motion);
    const auto length = static_cast<btScalar>(
        std::hypot(double{motion.x()}, double{motion.y()}, double{motion.z()}));
    for (int axis = 0; axis < 3; ++axis) {
      const btScalar direction = length > 0 ? motion[axis] / length : 0;
      found.m_rayDirectionInverse[axis] = direction == 0 ? BT_LARGE_FLOAT : 1 / direction;
      found.m_signs[axis] = found.m_rayDirectionInverse[axis] < 0 ? 1 : 0;
    }
    found.m_lambda_max = length;
    const float largest = std::max(largest_, largestCoordinate({&query.box, 1}));
    const float margin = std::max(kMargin * largest, std::numeric_limits<float>::min());
    const btVector3 margins(margin, margin, margin);
    tree_.rayTest(start, start + motion, found, min - start - margins, max - start + margins);
  }

  [[nodiscard]] Aabb leafOf(std::uint32_t body) const {
    return boxOf(proxies_[body]->leaf->volume);
  }
  [[nodiscard]] bool reachesTooFar(std::uint32_t body) const {
    return !contains(enlarged(boxes()[body], margin()), leafOf(body));
  }

  void create(std::uint32_t body) {
    tree_.m_gid = static_cast<int>(body);  // id of the next proxy
    const Aabb& box = boxes()[body];
    proxies_[body] = static_cast<btDbvtProxy*>(
        tree_.createProxy(vectorOf(box.min), vectorOf(box.max), BOX_SHAPE_PROXYTYPE, nullptr,
                          btBroadphaseProxy::DefaultFilter, btBroadphaseProxy::AllFilter, nullptr));
  }

  /// Inserts bodies that never collide into the tree at rest, before all others.
  void putToRest(const CollisionFilter& filter, std::span<const std::uint32_t> bodies) {
    const NonCollidingLayers layers(filter, bodies);
    if (layers.bodyCount() == 0) return;
    const bool deferred = tree_.m_deferedcollide;
    tree_.m_deferedcollide = true;  // no pair search on creation,
    for (const std::uint32_t body : bodies) {
      if (layers.contains(filter.layerOf(body))) create(body);
    }
    tree_.m_deferedcollide = false;  // nor here, where all become at rest
    for (int stage = 0; stage < Tree::STAGECOUNT; ++stage) tree_.collide(nullptr);
    tree_.m_deferedcollide = deferred;
    // Bullet would otherwise do this incrementally in the next hundred frames, and again whenever a
    // body comes to rest. (Its optimizeTopDown() fails for boxes with a common centre.)
    btDbvt& at_rest = tree_.m_sets[Tree::FIXED_SET];
    at_rest.optimizeIncremental(at_rest.m_leaves);
    tree_.m_fixedleft = 0;
    tree_.m_fupdates = 0;
  }

  /// Bullet would traverse all pairs for each destroyed proxy: here they are traversed once.
  void destroyVanished() {
    const auto has_vanished = [this](std::uint32_t body) {
      return isEmpty(boxes()[body]) && proxies_[body] != nullptr;
    };
    if (std::ranges::none_of(moved(), has_vanished)) return;
    btOverlappingPairCache& pairs = *tree_.m_paircache;
    for (int i = pairs.getNumOverlappingPairs(); i-- > 0;) {
      const btBroadphasePair pair = pairs.getOverlappingPairArray()[i];
      if (isEmpty(boxes()[bodyOf(*pair.m_pProxy0)]) || isEmpty(boxes()[bodyOf(*pair.m_pProxy1)])) {
        pairs.removeOverlappingPair(pair.m_pProxy0, pair.m_pProxy1, nullptr);
      }
    }
    btNullPairCache none;
    tree_.m_paircache = &none;
    for (const std::uint32_t body : moved()) {
      if (has_vanished(body)) tree_.destroyProxy(std::exchange(proxies_[body], nullptr), nullptr);
    }
    tree_.m_paircache = &pairs;
  }

  void move(std::uint32_t body) {
    const btVector3 min = vectorOf(boxes()[body].min);
    const btVector3 max = vectorOf(boxes()[body].max);
    tree_.setAabb(proxies_[body], min, max, nullptr);
    // The box shrank, or, far from the origin, the margin was rounded up.
    if (reachesTooFar(body)) tree_.setAabbForceUpdate(proxies_[body], min, max, nullptr);
  }

  /// Updates Bullet's pairs.
  void updatePairs() {
    // Bullet checks for stale pairs from the m_cid-th on, at least as many as are new: so all.
    tree_.m_cid = 0;
    tree_.m_newpairs += tree_.m_paircache->getNumOverlappingPairs();
    tree_.calculateOverlappingPairs(nullptr);
  }

  static void drawTree(DebugDraw& draw, const btDbvt& tree, StructureRole role) {
    std::vector<std::pair<const btDbvtNode*, int>> open;
    if (tree.m_root != nullptr) open.emplace_back(tree.m_root, 0);
    while (!open.empty()) {
      const auto [node, depth] = open.back();
      open.pop_back();
      draw.box(boxOf(node->volume), role, depth);
      if (node->isleaf()) continue;
      for (const btDbvtNode* const child : node->childs) open.emplace_back(child, depth + 1);
    }
  }

  double margin_ = 0.05;  ///< Bullet's default
  bool answers_queries_ = false;
  float largest_ = 0;  ///< the largest coordinate, of either sign, when queries are answered
  Changes changes_;
  Tree tree_;
  std::vector<btDbvtProxy*> proxies_;  ///< by body; owned; null: absent
  std::uint64_t reinsertions_ = 0;     ///< of this frame
};

}  // namespace

std::vector<Algorithm> variants() {
  const Algorithm family = {
      .family = "DBVT",
      .traits = {.incremental = true,
                 .events = true,
                 .queries = {AnswerKind::boxes, AnswerKind::rays, AnswerKind::sweeps},
                 .library_allocates = true,
                 .library_aborts = true,
                 .changing_worlds = ChangingWorlds::native,
                 .instance_per_world = true,
                 .max_objects = 0x7FFF'FFFE,
                 .exclusive = std::string(kBulletTreeMargin)},
      .description = {.principle = "tree",
                      .optimisations = "incremental, fat leaves, separate tree for bodies at rest",
                      .time = "O(m log n + k), m bodies that move",
                      .space = "O(n + k)",
                      .source = "Bullet, btDbvtBroadphase; van den Bergen 1997"}};
  return {variantOf<Dbvt>(family, "dbvt-f",
                          "Bullet's dynamic AABB trees, queried for each moved body (forward)", {},
                          /*deferred=*/false),
          variantOf<Dbvt>(family, "dbvt-d",
                          "Bullet's dynamic AABB trees, traversed once per frame (deferred)", {},
                          /*deferred=*/true)};
}

}  // namespace broadmark::dbvt
