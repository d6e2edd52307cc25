// KD: an adaptive KD tree that is updated incrementally, with pairs that are retained.
//
//   updateObjects     box inside its fat box? then unchanged, else moved: new fat box
//   cleanCache        retain the pairs of two unchanged bodies, drop the others
//   updateStructures  mark dirty, insert -> refit (bottom-up) -> restructure (top-down)
//   searchOverlaps    add the pairs of moved bodies, within the tree and with the static BVH;
//                     with a margin, select the pairs with overlapping boxes
//   If half of the bodies or more have moved, all are treated as moved.
//
//          x | 4                  array of bodies, with a contiguous slice per node
//       own: straddling           +------------------------------+-----------+-------------+
//        /        \               | left                         | own       | right       |
//     y | 2      leaf             +-------+-----------+----------+ straddle  | leaf:       |
//    /     \                      | leaf  | own       | leaf     | x = 4     | all its own |
//  leaf   leaf                    +-------+-----------+----------+-----------+-------------+
//
// The tree and the retained pairs are those of the fat boxes; as boxes are tested last, the answer
// is exact. For events, the pairs found and dropped are tested with the boxes before and now.
//
// Bodies of non-colliding layers, such as static geometry, are in a static BVH until they first
// move: a frame in which few of many bodies move costs no more than these.
//
// O(m log n + w) per frame, m moved bodies and w pairs tested; O(n log n) if everything moved.
//
// Source: Y. R. Serpa and M. A. F. Rodrigues, "Flexible Use of Temporal and Spatial Reasoning for
// Fast and Scalable CPU Broad-Phase Collision Detection Using KD-Trees", Computer Graphics Forum,
// 2019; threads and the static BVH are additions. Fat AABBs as in Bullet (btDbvt) and Box2D.

#include <algorithm>
#include <cstdint>
#include <deque>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "kd/search.h"
#include "kd/static_bvh.h"
#include "kd/tree.h"
#include "variants.h"

namespace broadmark::kd {
namespace {

/// Directly on BroadPhase: pairs are retained between frames, unlike a layer's buffers.
class Kd final : public BroadPhase {
 public:
  void visitParameters(const ParameterVisitor& visit) override {
    visit({"objects_per_leaf", "number of bodies above which a leaf is split", &objects_per_leaf_,
           1, 1'000'000});
    visit({"margin",
           "margin of the fat AABBs, in world units: a body is updated once its box leaves it",
           &margin_, 0, 1'000'000});
  }

  void initialize(const SceneInfo& scene, const Frame& first,
                  ExecutionContext& execution) override {
    team_ = &execution.team();
    world_ = scene.world;
    filter_ = scene.filter;
    boxes_.assign(first.boxes.begin(), first.boxes.end());
    for (const Aabb& box : boxes_) fat_boxes_.push_back(fatten(box));
    is_moved_.resize(fat_boxes_.size());
    for (int worker = 0; worker < team_->size(); ++worker) workers_.emplace_back(execution.isa());
    for (Worker& worker : workers_) {
      worker.moved.reserve(fat_boxes_.size() / workers_.size() + 1);
      worker.inserted.reserve(fat_boxes_.size() / workers_.size() + 1);
    }
    pair_runs_.resize(workers_.size());
    kernels_ = &overlapKernels(execution.isa());
    std::vector<std::uint32_t> bodies = first.presentBodies();
    static_bvh_.build(fat_boxes_, bodies, filter_, team_->size());
    std::erase_if(bodies, [this](std::uint32_t body) { return static_bvh_.contains(body); });
    tree_.build(fat_boxes_, is_moved_, bodies, static_cast<std::size_t>(objects_per_leaf_), *team_);
    if (reports_events_) beginEvents();
  }

  /// Finds the moved bodies: only these are searched for. The margin absorbs small moves.
  void updateObjects(const Frame& frame) override {
    const std::span<const std::uint32_t> changed = *frame.changed;
    clearMoved();
    team_->run(changed.size(), [&](int part, Range range) {
      Worker& worker = workers_[static_cast<std::size_t>(part)];
      for (const std::uint32_t body : changed.subspan(range.begin, range.size())) {
        applyBox(worker, body, frame.boxes[body]);
      }
    });
    moved_count_ = 0;
    for (Worker& worker : workers_) {
      moved_count_ += worker.moved.size() + worker.inserted.size();
      static_bvh_.countRemoved(std::exchange(worker.removed_static, 0));
    }
    // Before the first search there are no pairs to retain.
    is_incremental_ = has_searched_ && 2 * moved_count_ < tree_.size() + static_bvh_.size();
  }

  /// Drops the pairs of moved bodies, which are searched for again; before, finds those that end.
  void cleanCache() override {
    if (reports_events_) forWorkers([this](Worker& worker, Range) { findEnded(worker); });
    forWorkers([this](Worker& worker, Range part) {
      if (is_incremental_) {
        if (moved_count_ > 0) worker.pairs.retain([this](Pair p) { return isUnchanged(p); });
      } else {
        worker.pairs.clear();
        fillMoved(part, 1);
      }
      worker.retained = worker.pairs.size();
    });
  }

  /// Only nodes with moved bodies are dirty; the tree skips all others.
  void updateStructures() override {
    tree_.beginUpdate(!is_incremental_);
    if (is_incremental_ && moved_count_ > 0) {
      team_->run([this](int part) {
        for (const std::uint32_t body : workers_[static_cast<std::size_t>(part)].moved) {
          tree_.markDirty(body);
        }
      });
    }
    for (const Worker& worker : workers_) tree_.insert(worker.inserted);
    tree_.update();
  }

  /// Adds the pairs with a moved body to the retained pairs, then derives the answer.
  void searchOverlaps() override {
    const Searcher::Scene scene = {tree_, fat_boxes_, is_moved_,
                                   filter_.wantsAll() ? nullptr : &filter_};
    team_->run([&](int part) {
      Worker& worker = workers_[static_cast<std::size_t>(part)];
      worker.searcher.search(scene, part, team_->size(), worker.pairs);
      queryStaticBvh(worker, part);
      if (reports_events_) {
        findBegun(worker);
      } else {
        pair_runs_[static_cast<std::size_t>(part)] =
            margin_ > 0 ? exactPairs(worker) : worker.pairs.run();
      }
    });
    has_searched_ = true;
    if (!reports_events_) return;
    for (std::size_t i = 0; i < workers_.size(); ++i) {
      began_runs_[i] = workers_[i].began.run();
      ended_runs_[i] = workers_[i].ended.run();
    }
  }

  [[nodiscard]] PairRuns overlaps() const override { return pair_runs_; }

  void reportEvents() override { reports_events_ = true; }
  [[nodiscard]] PairEvents events() const override { return {began_runs_, ended_runs_}; }

  void drawStructure(DebugDraw& draw) const override { tree_.draw(draw, world_); }
  void visitCounters(const CounterVisitor& visit) const override;
  [[nodiscard]] std::string validate() const override;

 private:
  struct alignas(64) Worker {
    explicit Worker(Isa isa) : searcher(isa) {}

    Searcher searcher;
    StaticBvh::Scratch static_query;
    PairBuffer pairs;          ///< of the fat boxes
    std::size_t retained = 0;  ///< number of pairs from previous frames, which come first
    PairBuffer exact_pairs;    ///< the answer, if there is a margin
    // In this frame.
    std::vector<std::uint32_t> moved;     ///< bodies in the tree, including vanished ones
    std::vector<std::uint32_t> inserted;  ///< bodies to be inserted into the tree
    std::size_t removed_static = 0;       ///< bodies removed from the static BVH
    // For events.
    std::vector<std::uint32_t> changed;
    PairBuffer began;
    PairBuffer ended;
  };

  // updateObjects: the bodies of the last frame are unchanged until they move again.
  void clearMoved() {
    forWorkers([this](Worker& worker, Range part) {
      if (is_incremental_) {
        for (const std::uint32_t body : worker.moved) is_moved_[body] = 0;
        for (const std::uint32_t body : worker.inserted) is_moved_[body] = 0;
      } else {
        fillMoved(part, 0);
      }
      worker.moved.clear();
      worker.inserted.clear();
      for (const std::uint32_t body : worker.changed) boxes_before_[body] = boxOf(body);
      worker.changed.clear();
    });
  }

  void fillMoved(Range bodies, std::uint8_t value) {
    std::fill(is_moved_.begin() + static_cast<std::ptrdiff_t>(bodies.begin),
              is_moved_.begin() + static_cast<std::ptrdiff_t>(bodies.end), value);
  }

  void applyBox(Worker& worker, std::uint32_t body, const Aabb& box) {
    if (reports_events_) {
      boxes_before_[body] = boxOf(body);
      worker.changed.push_back(body);
    }
    if (margin_ > 0) boxes_[body] = box;
    const bool is_in_tree = tree_.contains(body);
    const bool is_static = !is_in_tree && static_bvh_.contains(body);
    if ((is_in_tree || is_static) && isInsideFatBox(box, fat_boxes_[body])) return;
    fat_boxes_[body] = fatten(box);
    is_moved_[body] = 1;
    if (is_static) {
      static_bvh_.remove(body);
      ++worker.removed_static;
    }
    // A static body that vanishes is inserted and removed in one update, which drops its pairs.
    (is_in_tree ? worker.moved : worker.inserted).push_back(body);
  }

  /// Whether the fat box contains the box and is no larger than its moves require: a body that
  /// shrinks gets a new fat box, too. Branchless, since the result is unpredictable.
  [[nodiscard]] bool isInsideFatBox(const Aabb& box, const Aabb& fat_box) const {
    const float slack = 2 * static_cast<float>(margin_);
    int inside = 1;
    for (int axis = 0; axis < 3; ++axis) {
      inside &= static_cast<int>(fat_box.min[axis] <= box.min[axis]);
      inside &= static_cast<int>(box.min[axis] - slack <= fat_box.min[axis]);
      inside &= static_cast<int>(box.max[axis] <= fat_box.max[axis]);
      inside &= static_cast<int>(fat_box.max[axis] <= box.max[axis] + slack);
    }
    return inside != 0;
  }
  [[nodiscard]] Aabb fatten(const Aabb& box) const {
    return isEmpty(box) ? Tree::kAbsent : enlarged(box, static_cast<float>(margin_));
  }

  [[nodiscard]] bool isUnchanged(Pair pair) const {
    return (is_moved_[pair.a] | is_moved_[pair.b]) == 0;
  }

  /// With a margin, retained pairs may end as well.
  void findEnded(Worker& worker) {
    worker.ended.clear();
    const bool retained_may_end = margin_ > 0;
    if (moved_count_ == 0 && !retained_may_end) return;
    for (const Pair pair : worker.pairs.run()) {
      if (!retained_may_end && isUnchanged(pair)) continue;
      if (overlappedBefore(pair) && !overlapNow(pair)) worker.ended.add(pair.a, pair.b);
    }
  }

  // searchOverlaps: the tree finds no pairs with static bodies.
  void queryStaticBvh(Worker& worker, int part) {
    worker.static_query.boxes_tested = 0;
    if (static_bvh_.size() == 0) return;
    const auto query = [&](std::span<const std::uint32_t> bodies) {
      for (const std::uint32_t body : bodies) {
        if (!tree_.contains(body) || !static_bvh_.collidesWith(body)) continue;
        static_bvh_.query(body, fat_boxes_[body], part, *kernels_, worker.static_query,
                          worker.pairs);
      }
    };
    if (is_incremental_) {
      query(worker.moved);
      query(worker.inserted);
    } else {
      const auto [begin, end] = share(tree_.size(), team_->size(), part);
      query(tree_.bodies().subspan(begin, end - begin));
    }
  }

  PairRun exactPairs(Worker& worker) const {
    const PairRun pairs = worker.pairs.run();
    worker.exact_pairs.clear();
    Pair* const room = worker.exact_pairs.room(pairs.size());
    std::size_t count = 0;
    for (const Pair pair : pairs) {
      room[count] = pair;
      count += broadmark::overlaps(boxes_[pair.a], boxes_[pair.b]) ? 1 : 0;
    }
    worker.exact_pairs.advance(count);
    return worker.exact_pairs.run();
  }

  void findBegun(Worker& worker) {
    worker.began.clear();
    for (const Pair pair : worker.pairs.run().subspan(margin_ > 0 ? 0 : worker.retained)) {
      if (overlapNow(pair) && !overlappedBefore(pair)) worker.began.add(pair.a, pair.b);
    }
  }

  /// All pairs of the initial pose begin.
  void beginEvents() {
    began_runs_.resize(workers_.size());
    ended_runs_.resize(workers_.size());
    boxes_before_.assign(fat_boxes_.size(), kEmptyBox);
    cleanCache();
    updateStructures();
    searchOverlaps();
    for (std::uint32_t body = 0; body < boxes_before_.size(); ++body) {
      boxes_before_[body] = boxOf(body);
    }
  }

  /// Without a margin the fat boxes are the boxes.
  [[nodiscard]] Aabb boxOf(std::uint32_t body) const {
    if (margin_ > 0) return boxes_[body];
    return fat_boxes_[body] == Tree::kAbsent ? kEmptyBox : fat_boxes_[body];
  }
  [[nodiscard]] bool overlappedBefore(Pair pair) const {
    return broadmark::overlaps(boxes_before_[pair.a], boxes_before_[pair.b]);
  }
  [[nodiscard]] bool overlapNow(Pair pair) const {
    return broadmark::overlaps(boxOf(pair.a), boxOf(pair.b));
  }

  /// Calls work(worker, its share of the bodies) for all workers in parallel.
  template <class Work>
  void forWorkers(Work work) {
    team_->run(fat_boxes_.size(), [&](int part, Range bodies) {
      work(workers_[static_cast<std::size_t>(part)], bodies);
    });
  }

  /// Half of the paper's 512: with wide vectors, testing all pairs of a leaf is faster than
  /// sorting.
  std::int64_t objects_per_leaf_ = 256;
  double margin_ = 0;

  ThreadTeam* team_ = nullptr;
  const OverlapKernels* kernels_ = nullptr;
  Aabb world_;
  CollisionFilter filter_;
  std::vector<Aabb> boxes_;             ///< of this frame, if there is a margin
  std::vector<Aabb> fat_boxes_;         ///< of each body's last move; kAbsent: not present
  std::vector<std::uint8_t> is_moved_;  ///< 1: the pairs of this body are searched for
  std::size_t moved_count_ = 0;
  bool has_searched_ = false;
  bool is_incremental_ = false;  ///< pairs of two unchanged bodies are retained
  Tree tree_;
  StaticBvh static_bvh_;
  std::deque<Worker> workers_;
  std::vector<PairRun> pair_runs_;  ///< by worker
  bool reports_events_ = false;
  std::vector<Aabb> boxes_before_;  ///< of the previous frame, if events are reported
  std::vector<PairRun> began_runs_;
  std::vector<PairRun> ended_runs_;
};

void Kd::visitCounters(const CounterVisitor& visit) const {
  std::uint64_t retained = 0;
  std::uint64_t skipped = 0;
  std::uint64_t boxes_tested = 0;
  for (const Worker& worker : workers_) {
    retained += worker.retained;
    skipped += worker.searcher.skippedSubtrees();
    boxes_tested += worker.searcher.boxesTested() + worker.static_query.boxes_tested;
  }
  visit("moves", moved_count_);
  visit("bodies at rest", static_bvh_.size());
  visit("boxes tested", boxes_tested);
  tree_.visitCounters(visit);
  visit("subtrees skipped in searches", skipped);
  visit("pairs retained", retained);
}

std::string Kd::validate() const {
  for (std::uint32_t body = 0; body < fat_boxes_.size(); ++body) {
    const int count = (tree_.contains(body) ? 1 : 0) + (static_bvh_.contains(body) ? 1 : 0);
    if (count != (fat_boxes_[body] == Tree::kAbsent ? 0 : 1)) return "a body is in a wrong tree";
  }
  const std::string fault = static_bvh_.validate(fat_boxes_);
  return fault.empty() ? tree_.validate() : fault;
}

}  // namespace

std::vector<Algorithm> variants() {
  const Algorithm family = {
      .family = "KD",
      .traits = {.incremental = true,
                 .events = true,
                 .changing_worlds = ChangingWorlds::native,
                 .instance_per_world = true},
      .description = {
          .principle = "tree",
          .optimisations = "incremental tree and pairs",
          .time = "O(m log n + w), m moved bodies, w pairs tested",
          .space = "O(n + k)",
          .source = "Serpa and Rodrigues 2019, Flexible Use of Temporal and Spatial Reasoning"}};
  return {variantOf<Kd>(family, "kd", "adaptive KD tree; pairs of unchanged bodies are retained",
                        {.vectorised = true}),
          variantOf<Kd>(family, "kd-mt", "adaptive KD tree, on several threads",
                        {.parallel = true, .vectorised = true})};
}

}  // namespace broadmark::kd
